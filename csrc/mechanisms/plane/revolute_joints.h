/* Revolute joints between bodies that are free: two rows that hold a point of one body to a point of another. They need the ways from mass
 * centres to these points and nothing else, so that C is not stored for products with it. */
#ifndef ZD_PLANE_REVOLUTE_JOINTS_H
#define ZD_PLANE_REVOLUTE_JOINTS_H

#include "plan.h"

/* The data of pins lie in three arrays: most loops over all pins read one or two of them, and large mechanisms wait for memory. */
typedef struct zd_revolute_bodies {
    int first, second;      /* bodies */
    int row;                /* the first of the two */
} zd_revolute_bodies;

typedef struct zd_points {
    zd_vector first, second;    /* in the axes of each body */
} zd_points;

typedef struct zd_revolute_joint {
    zd_vector zero;         /* from the first point to the second where Phi is zero */
    int C, width;           /* where the first row begins in C, and how long each is */
    int near, far;          /* where in a row the entries of each body begin; -1: it is the ground */
    int near_turns, far_turns;  /* whether the body has an angle */
} zd_revolute_joint;

typedef struct zd_revolute_joints {
    int count;
    zd_revolute_bodies *between; /* (count,), and so are these: */
    zd_points *points;
    zd_revolute_joint *joint;
    int *end_at;            /* (bodies + 2,): where the pins of each body begin in */
    int *end;               /* (2 count,): 2 * pin, or 1 more where the body is its second */
    int are_all;            /* whether there are no other rows */
    int have_angles;        /* whether all bodies have three coordinates */
} zd_revolute_joints;

/* Whether rows `row` and the next are a pin: gauges of the same two points along x and y, of which nothing else is asked. */
int zd_is_revolute_joint_at(const zd_plane *mechanism, int row);
/* Which pins each body has, once these are there. */
void zd_revolute_joints_list(zd_revolute_joints *self, int bodies);
/* The ways to all points, where sines and cosines are known. */
void zd_revolute_joints_turn(const zd_revolute_joints *self, const zd_plane *mechanism, const zd_plane_frame *frame);
/* Phi, C and xi of all pins, as far as they are wanted. */
void zd_revolute_joints_write(const zd_revolute_joints *self, const zd_plane *mechanism, const zd_plane_frame *frame, int want, const double *p, const double *v,
                   const zd_terms *out);

/* x (nv,) with three entries for each body: as it is, where all have them, else in `to`. */
const double *zd_revolute_joints_spread(const zd_revolute_joints *self, const zd_plane_tree *tree, const double *x, double *to);
/* Those of body i. */
static inline const double *zd_of_body(const double *spread, int i)
{
    static const double of_ground[3] = {0, 0, 0};
    return i ? spread + 3 * (i - 1) : of_ground;
}

#endif
