/* Revolute joints between free bodies: two rows for the coincidence of a point of one body and a point of another. They are written from
 * the vectors from mass centres to these points alone, so that products with C do not need its stored entries. */
#ifndef ZD_PLANE_REVOLUTE_JOINTS_H
#define ZD_PLANE_REVOLUTE_JOINTS_H

#include "../plan.h"

/* The data are split into three arrays: most loops read one or two of them, and large mechanisms are bound by memory bandwidth. */
typedef struct zd_revolute_bodies {
    int first, second;      /* bodies */
    int row;                /* index of the first of its two rows */
} zd_revolute_bodies;

typedef struct zd_points {
    zd_vector first, second;    /* in the axes of each body */
} zd_points;

typedef struct zd_revolute_joint {
    zd_vector zero;         /* vector from the first point to the second at Phi = 0 */
    int C, width;           /* offset of the first row in C, and length of each row */
    int near, far;          /* offsets of the bodies' entries in a row; -1: the body is the ground */
    int near_turns, far_turns;  /* 1 if the body has an angle */
} zd_revolute_joint;

typedef struct zd_revolute_joints {
    int count;
    zd_revolute_bodies *between; /* (count,), as the next two */
    zd_points *points;
    zd_revolute_joint *joint;
    int *end_at;            /* (bodies + 2,): offsets of each body's joints in `end` */
    int *end;               /* (2 count,): 2 * joint, plus 1 where the body is its second */
    int are_all;            /* 1 if there are no other rows */
    int have_angles;        /* 1 if all bodies have three coordinates */
} zd_revolute_joints;

/* True if `row` and the next are the x and y coincidence of the same two points, without further terms: a revolute joint. */
int zd_is_revolute_joint_at(const zd_plane *mechanism, int row);
/* Fills in end_at and end, after all joints were added. */
void zd_revolute_joints_list(zd_revolute_joints *self, int bodies);
/* frame->arm and frame->axis, from the sines and cosines. */
void zd_revolute_joints_turn(const zd_revolute_joints *self, const zd_plane *mechanism, const zd_plane_frame *frame);
/* Phi, C and xi of all revolute joints, as far as wanted. */
void zd_revolute_joints_write(const zd_revolute_joints *self, const zd_plane *mechanism, const zd_plane_frame *frame, int want,
                              const double *p,
                               const double *v, const zd_terms *out);

/* x (nv,) with three entries for each body: x itself if all bodies have three coordinates, otherwise a copy in `to`. */
const double *zd_revolute_joints_expand(const zd_revolute_joints *self, const zd_plane_tree *tree, const double *x, double *to);
/* Entries of body i; zeros for the ground. */
static inline const double *zd_of_body(const double *spread, int i)
{
    static const double of_ground[3] = {0, 0, 0};
    return i ? spread + 3 * (i - 1) : of_ground;
}

#endif
