/* Mechanisms from bodies and joints, in the plane: the tables that describe one, and the system that is made from them.
 *
 * Body 0 is the ground; bodies given have the numbers from 1 on. All points are in the axes of their body and from its mass centre (on
 * the ground: in the drawing's axes, from its origin). In joint coordinates each body is carried by a joint of the tree, and has that joint's
 * coordinate; a body that no joint carries has coordinates x, y of its mass centre, and its angle unless it is a particle. Absolute
 * coordinates are the same with an empty tree: then all bodies are free, and all joints are constraints.
 *
 * Plain declarations and nothing else: CFFI reads this very text. SI units, radians.
 */
#ifndef ZD_PLANE_TABLES_H
#define ZD_PLANE_TABLES_H

#include "../common/elements.h"
#include "joints/joint.h"
#include "link.h"

typedef struct zd_plane_body {
    double mass, inertia;       /* kg, kg m^2 about the mass centre */
    int is_particle;            /* has no angle */
    int carrier;                /* the joint of the tree that carries it; -1: it is free */
} zd_plane_body;

typedef struct zd_plane_joint {
    int kind;                   /* row of the table of joints */
    int first, second;          /* bodies */
    double point1[2], point2[2];
    double axis[2];             /* of length 1, in the first body's axes; where the kind takes none, whatever */
    double along, across;       /* m: what the distances along and across the axis are where the joint says zero */
    double angle;               /* rad: the second's less the first's angle where the joint says zero */
    double length;              /* m: of a rod; the radius of a rolling wheel */
} zd_plane_joint;

typedef struct zd_plane_gauge {
    int kind;                   /* enum zd_plane_gauge_kind */
    int first, second;          /* bodies */
    double point1[2], point2[2];
    double axis[2];             /* of length 1, in the first body's axes */
    double zero;                /* m or rad: taken from the reading */
} zd_plane_gauge;

typedef struct zd_plane_tables {
    double gravity[2];          /* m/s^2 */
    int bodies, joints, gauges;
    const zd_plane_body *body;        /* (bodies,) from number 1 on */
    const zd_plane_joint *joint;
    const zd_plane_gauge *gauge;
    zd_elements elements;
} zd_plane_tables;

/* What a coordinate of the system is. */
enum zd_plane_coordinate_kind { ZD_COORDINATE_X, ZD_COORDINATE_Y, ZD_COORDINATE_ANGLE, ZD_COORDINATE_DISPLACEMENT };

typedef struct zd_plane_coordinate_owner {
    int body;
    enum zd_plane_coordinate_kind kind;
} zd_plane_coordinate_owner;

typedef struct zd_plane zd_plane;

/* All memory is taken here, and the tables are copied but for names, which have to stay. On failure returns NULL and says why. */
zd_plane *zd_plane_create(const zd_plane_tables *tables, char *message, int message_size);
void zd_plane_free(zd_plane *mechanism);
/* The system; it refers to the mechanism. */
const zd_system *zd_plane_system(const zd_plane *mechanism);
const zd_row_owner *zd_plane_rows(const zd_plane *mechanism);                       /* (m,) */
const zd_plane_coordinate_owner *zd_plane_coordinates(const zd_plane *mechanism);         /* (nq,) */
/* Size in bytes of the data of the system, for a copy of it: see zd_plane_with(). */
int zd_plane_data_size(void);
/* Writes into `data` what the system's data is, but for the owner of the laws, as each run may have its own, for those of them that are
 * compiled (NULL: none), and for the numbers of functions that were written out from the plan: the pointer to these is what the data
 * begins with. */
void zd_plane_with(const zd_plane *mechanism, void *owner, const zd_compiled_law *compiled, const double *numbers, void *data);

/* A component of a measure that the start holds: of positions, or of velocities. */
typedef struct zd_target {
    int measure, component, is_rate;
    double value;
    int stays;              /* 1: behind all others; of positions the value is that of the drawing with its joints closed, and `value` is not read */
} zd_target;

/* What all joints and elements come down to: links of a tree, rows of gauges, and efforts along gauges. Bodies have the tree's numbers
 * here, in which inner ones come first. */
typedef struct zd_plane_plan {
    const zd_plane_link *link;        /* (bodies + 1,) the first one, of the ground, unused */
    const zd_plane_gauge *gauge;
    const zd_gauge_term *term;
    const zd_relation *row;     /* (m,) holonomic ones first */
    const zd_effort *effort;    /* (efforts,) */
} zd_plane_plan;

zd_plane_plan zd_plane_planned(const zd_plane *mechanism);

/* Poses (bodies, 3) of mass centres, x, y, angle, and their rates, from the state and back. What joints of the tree forbid is not looked
 * at. `rates` and `v` may be NULL; `scratch` holds system->scratch doubles. */
void zd_plane_poses(const zd_plane *mechanism, const double *p, const double *v, double *poses, double *rates, double *scratch);
void zd_plane_state(const zd_plane *mechanism, const double *poses, const double *rates, double *p, double *v);

/* Components of measures of positions and velocities, which (count, 2) <- measure and component, all at one state in absolute coordinates:
 * value (count,); where the velocities of the two bodies begin that each touches, at (count, 2), or -1 for the ground; and what zd_measured
 * has as its row at these, row (count, 2, 3). The cost is in proportion to bodies and components;
 * `scratch` holds measures->scratch doubles. */
void zd_plane_components(const zd_plane *mechanism, const double *p, const double *v, int count, const int *which, double *value,
                             int *at, double *row, double *scratch);

#endif
