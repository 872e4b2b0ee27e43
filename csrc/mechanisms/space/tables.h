/* Spatial mechanisms of bodies and joints: the tables that describe one, and the system that is created from them.
 *
 * Coordinates are absolute, unless bodies have inboard joints (../space_tree/tree.h). Those of a body are the position of its mass centre
 * and a unit quaternion, scalar first, that rotates body axes into global axes; its velocities are that of its mass centre in global axes,
 * and its angular velocity in body axes. These are its principal axes, so that M is constant and diagonal. A particle has a position and a
 * velocity only. Body 0 is the ground; given bodies are numbered from 1. The coordinates of bodies are followed by the joint angles, in the
 * order of joints, which count turns: unwrapped_angles.c. All points are in the axes of their body and from its mass centre (on the ground:
 * in global axes, from the global origin). Relations, generalized forces, measures and user functions are of marker quantities in space;
 * forces and torques have three components.
 *
 * Plain declarations only: CFFI parses this text. SI units, radians.
 */
#pragma once

#include "../common/elements.h"
#include "elements.h"

typedef struct zd_space_body {
    double mass;                /* kg */
    double inertia[3];          /* kg m^2, about its own axes through the mass centre */
    int is_particle;            /* has no orientation */
    int inboard;                /* its inboard joint; -1: it is free */
} zd_space_body;

typedef struct zd_space_joint {
    int kind;                   /* index in the table of joints in space */
    int first, second;          /* bodies */
    double point1[3], point2[3];
    double frame1[3][3], frame2[3][3];  /* directions of the joint's frame in the axes of each body; they coincide in the zero position */
    double semiaxes[3];         /* m: of the rolling ellipsoid, along the directions of frame2 */
    double along;               /* m: distance along the axis in the zero position; of a universal joint the cosine between its axes */
    double length;              /* m of a rod; m/rad of a screw */
} zd_space_joint;

typedef struct zd_space_quantity {
    int kind;                   /* enum zd_space_quantity_kind */
    int first, second;          /* bodies */
    double point1[3], point2[3];
    double a[3], o[3], b[3];    /* unit vectors in the axes of their body: see enum zd_space_quantity_kind */
    /* In the second body's axes: m^2, of an ellipsoid x^T shape^-1 x = 1 about Q; of a rotation the first body's axes where phi is zero. */
    double shape[3][3];
    double zero;                /* m or rad: subtracted from the value */
    int counted;                /* 1 + index of the joint angle, for an angle that counts turns; otherwise 0 */
} zd_space_quantity;

typedef struct zd_space_tables {
    double gravity[3];          /* m/s^2 */
    int bodies, joints, quantities;
    const zd_space_body *body;  /* (bodies,) from number 1 on */
    const zd_space_joint *joint;
    const zd_space_quantity *quantity;
    zd_elements elements;
} zd_space_tables;

typedef struct zd_space zd_space;

/* Allocates all memory and copies the tables, except names, which must outlive the mechanism. Returns NULL on failure, with the reason in
 * `message`. Mechanisms with inboard joints are created by zd_space_tree_create(). */
zd_space *zd_space_create(const zd_space_tables *tables, char *message, int message_size);
void zd_space_free(zd_space *space);
/* The system; it refers to the mechanism. */
const zd_system *zd_space_system(const zd_space *space);
const zd_constraint_owner *zd_space_rows(const zd_space *space);       /* (m,) */
/* Number of joint angles; place (angles,) <- the index of each in p. NULL: not wanted. */
int zd_space_angles(const zd_space *space, int *place);
/* Marker quantity of a coordinate of a joint, which its kind must have; `angles` is the number of angles of the joints before it. */
zd_space_quantity zd_space_coordinate_quantity(const zd_space_joint *joint, int coordinate, int angles);
/* As zd_plane_components(); row (count, 2, 6). */
void zd_space_components(const void *mechanism, const double *p, const double *v, int count, const int *which, double *value, int *at,
                         double *row, double *scratch);
/* Size in bytes of the data of the system; and a copy of these data with the run's own owner of user functions, user functions as expressions
 * (NULL: none), and inputs of generated functions. The pointer to these inputs is the first member of the data. */
int zd_space_data_size(void);
void zd_space_with(const zd_space *space, void *owner, const zd_law_program *program, const double *numbers, void *data);
/* zd_switches.evaluate() */
void zd_space_compare(const void *data, double t, const double *p, const double *v, double *value, double *scratch);

/* Planned form of all joints outside the tree and of all elements: rows, and generalized forces along marker quantities. */
typedef struct zd_space_plan {
    const zd_space_quantity *quantity;
    const zd_quantity_term *term;
    const zd_relation *row;         /* (m,) holonomic ones first */
    const zd_generalized_force *force;        /* (generalized forces,) */
} zd_space_plan;

zd_space_plan zd_space_planned(const zd_space *space);

/* Consistency of the tables of a spatial mechanism. */

/* Returns 1, or 0 with the violated rule in `message`. */
int zd_space_tables_are_right(const zd_space_tables *tables, char *message, int message_size);
