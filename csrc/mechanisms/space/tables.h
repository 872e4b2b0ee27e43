/* Mechanisms in space from bodies and joints: the tables that describe one, and the system that is made from them.
 *
 * Coordinates are absolute, unless joints carry bodies (../space_tree/tree.h). Each body has the position of its mass centre and a unit
 * quaternion, scalar first, which turns its own axes into the drawing's; its velocities are that of its mass centre in the drawing's axes,
 * and its angular velocity in its own. These are its principal axes, so that M is constant and diagonal. A particle has a position and a
 * velocity alone. Body 0 is the ground; bodies given have the numbers from 1 on. Behind the bodies are the angles of joints, in their
 * order, which count turns: unwrapped_angles.h. All points are in the axes of their body and from its mass centre (on the ground: in the drawing's
 * axes, from its origin). Relations, efforts, measures and laws are of gauges in space; forces and torques have three components.
 *
 * Plain declarations and nothing else: CFFI reads this very text. SI units, radians.
 */
#ifndef ZD_SPACE_TABLES_H
#define ZD_SPACE_TABLES_H

#include "../common/elements.h"
#include "joints/joint.h"

typedef struct zd_space_body {
    double mass;                /* kg */
    double inertia[3];          /* kg m^2, about its own axes through the mass centre */
    int is_particle;            /* has no orientation */
    int carrier;                /* the joint of the tree that carries it; -1: it is free */
} zd_space_body;

typedef struct zd_space_joint {
    int kind;                   /* row of the table of joints in space */
    int first, second;          /* bodies */
    double point1[3], point2[3];
    double frame1[3][3], frame2[3][3];  /* the directions of the joint's frame in the axes of each body; they coincide where it says zero */
    double semiaxes[3];         /* m: of what rolls, along the directions of frame2 */
    double along;               /* m: what the distance along the axis is where the joint says zero */
    double length;              /* m: of a rod; of a screw m for each rad */
} zd_space_joint;

typedef struct zd_space_gauge {
    int kind;                   /* enum zd_space_gauge_kind */
    int first, second;          /* bodies */
    double point1[3], point2[3];
    double a[3], o[3], b[3];    /* of length 1, in the axes of their body: see enum zd_space_gauge_kind */
    double shape[3][3];         /* m^2: of an ellipsoid x^T shape^-1 x = 1 about Q, in the second body's axes */
    double zero;                /* m or rad: taken from the reading */
    int counted;                /* of an angle that counts turns: 1 + which one it is of all angles of joints; 0: it does not */
} zd_space_gauge;

typedef struct zd_space_tables {
    double gravity[3];          /* m/s^2 */
    int bodies, joints, gauges;
    const zd_space_body *body;  /* (bodies,) from number 1 on */
    const zd_space_joint *joint;
    const zd_space_gauge *gauge;
    zd_elements elements;
} zd_space_tables;

typedef struct zd_space zd_space;

/* All memory is taken here, and the tables are copied but for names, which have to stay. On failure returns NULL and says why. Where
 * joints carry bodies, take zd_space_tree_create(). */
zd_space *zd_space_create(const zd_space_tables *tables, char *message, int message_size);
void zd_space_free(zd_space *space);
/* The system; it refers to the mechanism. */
const zd_system *zd_space_system(const zd_space *space);
const zd_row_owner *zd_space_rows(const zd_space *space);       /* (m,) */
/* How many angles of joints there are; place (angles,) <- which entry of p each is. NULL: not wanted. */
int zd_space_angles(const zd_space *space, int *place);
/* The gauge that reads a coordinate of a joint, which its kind has to have; the joints before it have so many angles. */
zd_space_gauge zd_space_coordinate_gauge(const zd_space_joint *joint, int coordinate, int angles);
/* As zd_plane_components(); row (count, 2, 6). */
void zd_space_components(const zd_space *space, const double *p, const double *v, int count, const int *which, double *value, int *at,
                         double *row, double *scratch);
/* Size in bytes of the data of the system, and that data but for the owner of the laws, as each run may have its own, for those of them that
 * are compiled, NULL: none, and for the numbers of functions that were written out from the plan: the pointer to these is what the data
 * begins with. */
int zd_space_data_size(void);
void zd_space_with(const zd_space *space, void *owner, const zd_compiled_law *compiled, const double *numbers, void *data);

/* What all joints outside the tree and all elements come down to: rows of gauges, and efforts along gauges. */
typedef struct zd_space_plan {
    const zd_space_gauge *gauge;
    const zd_gauge_term *term;
    const zd_relation *row;         /* (m,) holonomic ones first */
    const zd_effort *effort;        /* (efforts,) */
} zd_space_plan;

zd_space_plan zd_space_planned(const zd_space *space);

#endif
