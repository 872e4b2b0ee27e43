/* Error of a step in the rotation of a unit quaternion. */
#ifndef ZD_TURNING_H
#define ZD_TURNING_H

#include "../motion/motion.h"
#include "../motion/state.h"

typedef struct zd_turning {
    zd_motion *motion;
    const zd_last *last;        /* the step */
    const double *vdot0, *pdot0, *pdot1;    /* (nv,), (nq,), (nq,): rates at its start; at its end */
    double *A0, *scratch;       /* stored as the point's: A at the start, and scratch memory of the system */
    double *before, *after;     /* (nq,): A vdot at both ends */
} zd_turning;

zd_turning zd_turning_create(zd_arena *arena, zd_motion *motion, const zd_last *last, const double *vdot0, const double *pdot0,
                           const double *pdot1);
/* A at both ends of the step, for all quaternions; the point's vdot is known. */
int zd_turning_evaluate(zd_turning *self);
/* Defect of quaternion k in the step, and its angle of rotation, both in rad. */
void zd_turning_compare(const zd_turning *self, int k, double h, double *missed, double *turned);

#endif
