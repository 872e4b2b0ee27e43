/* Whether steps of fixed size resolve each part of the motion. */
#ifndef ZD_RESOLUTION_H
#define ZD_RESOLUTION_H

#include "turning.h"

typedef struct zd_resolution {  /* (nv + quaternions,): what the steps miss of each coordinate's motion, in natural units */
    zd_motion *motion;
    const zd_last *last;    /* the step */
    const double *vdot0;    /* (nv,): where it began */
    int by_velocity;        /* whether velocities are looked at instead of coordinates, whose rates they are not */
    int order;              /* of the method */
    double weight;          /* what the error is of what is missed */
    double *error, *path;   /* sums over the last thousand steps or so: of what is missed, of the distance covered */
    double *place, *lowest, *highest;   /* (nv,): where it is; the range in which it has moved */
    zd_turning turning;     /* of the quaternions */
    int64_t step;              /* the last step that was looked at */
    int is_ample;           /* whether all that was missed until then is far from what is noted */
} zd_resolution;

/* Where a step begins are vdot0 and pdot0, and where it ends is pdot1. */
zd_resolution zd_resolution_take(zd_arena *arena, zd_motion *motion, int order, const zd_last *last, const double *vdot0,
                                 const double *pdot0, const double *pdot1);
int zd_resolution_look(zd_resolution *self, double h, int64_t step);      /* the acceleration is known at both ends of the step */
/* The same of the rotations alone, for the first of so many parts of a step. */
int zd_resolution_look_at_turns(zd_resolution *self, double h, int64_t step, int parts);

#endif
