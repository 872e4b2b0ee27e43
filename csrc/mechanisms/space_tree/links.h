/* Connections of bodies to their parents, as determined by their inboard joints. */
#pragma once

#include "../space/plan.h"

/* Three directions: those of a joint's frame, or of a body, and in whose axes is said where they stand. */
typedef struct zd_space_axes {
    zd_vector3 d[ZD_SPACE_AXES];
} zd_space_axes;

/* Freedom of the inboard joint of a body, in the order in which the joint's frame moves from the parent to the body. */
typedef struct zd_space_link_freedom {
    enum zd_space_freedom_kind kind;
    int direction;          /* index of the direction in the joint's moving frame */
    double sign;            /* -1 where the joint is taken backwards */
    double zero;            /* m: the distance along the direction where the coordinate is zero */
    double length;          /* m for each rad of what advances */
    int p, v;               /* its coordinates and velocities, from the first of all */
} zd_space_link_freedom;

typedef struct zd_space_link {
    int inner;              /* its parent; for a free body the ground */
    int is_free, turns;     /* turns: it has an orientation */
    int depth;              /* number of bodies from it down to the ground, itself included */
    int p, v, nq, nv;       /* its own coordinates and velocities */
    int freedoms;
    zd_space_link_freedom freedom[ZD_SPACE_FREEDOMS];
    zd_vector3 near, far;   /* the joint's point in the inner body's axes, and in its own */
    zd_space_axes near_axes, far_axes;   /* the joint's frame, in the same */
} zd_space_link;

/* Origins of the joint's frame in global axes, before each freedom and after the last. */
typedef struct zd_space_way {
    zd_vector3 at[ZD_SPACE_FREEDOMS + 1];
} zd_space_way;

typedef struct zd_space_composite {  /* a body with all that hangs on it, as if its joints were fixed */
    double mass;
    zd_vector3 first;           /* kg m: its mass times the way from the body's mass centre to its own */
    double second[6];           /* kg m^2: inertia about the body's mass centre, xx, yy, zz, xy, xz, yz, in global axes */
} zd_space_composite;

typedef struct zd_space_tree {
    int bodies, nq, nv;
    const zd_space_link *link;       /* (bodies + 1,), the first one unused */
    const int *order;           /* (bodies,) parents before children */
} zd_space_tree;

/* The tree's part of a frame, in its scratch. */
typedef struct zd_space_tree_frame {
    zd_space_twist *column;          /* (nv,) the twist of the body's mass centre where it moves by this velocity alone */
    zd_space_way *way;               /* (bodies + 1,) */
    zd_space_twist *change;          /* (bodies + 1,) accelerations */
    zd_space_composite *composite;   /* (bodies + 1,) */
} zd_space_tree_frame;

int zd_space_tree_frame_size(int bodies, int nv);
zd_space_tree_frame zd_space_tree_frame_of(const zd_space_tree *tree, const zd_space_frame *frame);

static inline const zd_space_tree *zd_space_tree_of(const zd_space *space) { return space->carrying.tree; }

/* Inward recursion: generalized forces of wrenches on bodies, and the wrenches that joints transmit. */

/* row (nv,) += scale times the generalized force of a unit force along a marker quantity. It is exactly zero for common ancestors of both
 * bodies, unless the force acts on one body alone, or a particle between them transmits no torque. */
void zd_space_tree_act(const zd_space *space, const zd_space_frame *frame, const zd_space_quantity *quantity, double scale,
                       const zd_space_reading *reading,
                  double *row);
/* to (nv,) <- generalized forces of the wrenches on all bodies, frame->wrench, which is overwritten. */
void zd_space_tree_gather(const zd_space *space, const zd_space_frame *frame, double *to);
/* frame->wrench: required wrench on each body individually -> wrench transmitted to each body from its parent. */
void zd_space_tree_transmit(const zd_space *space, const zd_space_frame *frame);
/* Wrench on the parent that is transmitted from a wrench on a body; a particle transmits no torque. */
zd_space_wrench zd_space_tree_pass(const zd_space_link *link, const zd_space_pose *pose, int body, zd_space_wrench what);

/* Outward: from coordinates to poses, velocities and accelerations. */

/* frame->pose, and the columns of the tree's Jacobian. */
void zd_space_tree_place(const zd_space *space, const zd_space_frame *frame, const double *p);
/* frame->twist, and in frame->bias accelerations where vdot is zero. */
void zd_space_tree_move(const zd_space *space, const zd_space_frame *frame, const double *v);
/* Accelerations, to the tree's frame, of one that is moving. */
void zd_space_tree_accelerate(const zd_space *space, const zd_space_frame *frame, const double *vdot);
/* A frame after a turn about one of its directions. */
void zd_space_tree_turn_axes(zd_space_axes *F, int direction, double angle);
/* Attitude of a body. */
zd_rotation zd_space_tree_attitude(const zd_space_tree *tree, int body, const double *p);
/* A of (1), without the rows of dependent angles: ones, and for quaternions half of q times (0, omega). A (nq, nv) must be zero before. */
void zd_space_tree_write_A(const zd_space_tree *tree, const double *p, double *A);

/* Mass matrix and inertia forces. */

/* M (nv, nv) of a frame that is placed. */
void zd_space_tree_mass(const zd_space *space, const zd_space_frame *frame, double *M);
/* d (nv,) of one that is moving; frame->wrench is used up. */
void zd_space_tree_bias(const zd_space *space, const zd_space_frame *frame, double *d);
/* Force and torque about the mass centre that give a body its acceleration. */
zd_space_wrench zd_space_tree_need(const zd_space_planned_body *body, const zd_space_pose *pose, const zd_space_twist *twist,
                                   const zd_space_twist *change);

/* Reactions of inboard joints. */

/* See zd_carrying. */
int zd_space_tree_reaction(const zd_space *space, const zd_space_frame *frame, int joint, zd_vector3 point,
                           const zd_measured_state *at, zd_space_wrench *reaction);

/* Magnitudes of the gradients of constraints and of generalized forces before cancellation, in joint coordinates of space: see zd_system. */

int zd_space_tree_magnitudes(const void *data, double t, const double *p, const double *v, double *magnitude, double *scratch);
int zd_space_tree_force_magnitudes(const void *data, const double *inputs, double t, const double *p, const double *v, double *magnitude,
                                   double *scratch);

/* Unwrapped joint angles: independent coordinates of inboard joints, dependent coordinates of all other joints. */

/* Rows of A (nq, nv) of the dependent angles, from placed bodies; they must be zero before. */
void zd_space_tree_write_rates(const zd_space *space, const zd_space_frame *frame, double *A);
/* Updates the dependent angles in p, keeping their full turns. */
void zd_space_tree_follow(const void *data, double *p);

/* The equations of motion of a tree of bodies in space. */

zd_evaluate zd_space_tree_evaluate;
