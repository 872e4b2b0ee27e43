/* What a step misses of the rotation of a unit quaternion. */
#ifndef ZD_TURNING_H
#define ZD_TURNING_H

#include "../motion/motion.h"
#include "../motion/place.h"

typedef struct zd_turning {
    zd_motion *motion;
    const zd_last *last;        /* the step */
    const double *vdot0, *pdot0, *pdot1;    /* (nv,), (nq,), (nq,): where it began; where it has ended */
    double *A0, *scratch;       /* as the point's: A where it began, and what the system keeps in its evaluation */
    double *before, *after;     /* (nq,): A vdot at both ends */
} zd_turning;

zd_turning zd_turning_take(zd_arena *arena, zd_motion *motion, const zd_last *last, const double *vdot0, const double *pdot0,
                           const double *pdot1);
/* A at both ends of the step, for all quaternions; the point's vdot is known. */
int zd_turning_evaluate(zd_turning *self);
/* Of quaternion k: what the step misses, and how far it has turned, rad. */
void zd_turning_compare(const zd_turning *self, int k, double h, double *missed, double *turned);

#endif
