/* Resolution of the motion by fixed steps, coordinate by coordinate. */
#ifndef ZD_RESOLUTION_H
#define ZD_RESOLUTION_H

#include "turning.h"

typedef struct zd_resolution {
    zd_motion *motion;
    const zd_last *last;    /* the step */
    const double *vdot0;    /* (nv,): acceleration at the start of the step */
    int by_velocity;        /* true if velocities are checked instead of coordinates, since pdot = A v with a kinematic matrix */
    int order;              /* order of the method */
    double weight;          /* ratio of the error of a step to its defect */
    double *error, *path;   /* (nv + quaternions,) in characteristic scales: decaying sums of errors, and of distances covered */
    double *place, *lowest, *highest;   /* (nv,): present value; the range in which it has moved */
    zd_turning turning;     /* defects of the quaternions */
    int64_t step;              /* the last checked step */
    int is_ample;           /* true if all errors were far below their bounds then */
} zd_resolution;

/* vdot0 and pdot0 are the rates at the start of a step, pdot1 those at its end. */
zd_resolution zd_resolution_create(zd_arena *arena, zd_motion *motion, int order, const zd_last *last, const double *vdot0,
                                 const double *pdot0, const double *pdot1);
int zd_resolution_check(zd_resolution *self, double h, int64_t step);      /* requires the acceleration at both ends of the step */
/* The same for rotations only, from the first of several equal parts of a step. */
int zd_resolution_check_turns(zd_resolution *self, double h, int64_t step, int parts);

#endif
