/* All of p and v, and states in independent velocities: for integrators whose polynomial is that of (p, v). */
#include "../linalg/small.h"
#include "motion.h"

int zd_motion_expand(void *context, double t, const double *y, double *whole)
{
    zd_motion *motion = context;
    const zd_point *point = motion->point;
    int status = motion->formulation->unpack(motion->solver, motion->point, t, y);
    zd_copy_few(motion->system.nq, point->p, whole);
    zd_copy_few(motion->system.nv, point->v, whole + motion->system.nq);
    return status;
}

int zd_motion_reduce(void *context, double t, const double *whole, double *y)
{
    zd_motion *motion = context;
    zd_point_move(motion->point, t, whole, whole + motion->system.nq);
    return motion->formulation->express(motion->solver, motion->point, y);
}
