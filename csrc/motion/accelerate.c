/* The equations of motion at a point, and the rate of the integrated state that follows from them. */
#include "../constraints/limits.h"
#include "../linalg/small.h"
#include "motion.h"

static void stabilize(zd_motion *motion)
{
    for (int i = 0; i < motion->corrections; i++) {
        const zd_active *active = &motion->active[i];
        if (active->row->stabilize)
            active->row->stabilize(active->self, motion->point, motion->state + motion->formulation_size + active->extra, motion->point->rhs);
    }
}

int zd_motion_accelerate_anew(zd_motion *motion)
{
    zd_point *point = motion->point;
    int status = zd_point_need(point, motion->acceleration_needs);
    if (!status) status = zd_motion_factor(motion);
    if (status) return status;
    zd_point_force(point, point->force);
    ZD_SIZED(zd_copy, zd_constraints(point->system), point->terms.xi, point->rhs);
    if (motion->is_stabilized) stabilize(motion);
    status = zd_limits_replace(point, ZD_LIMIT_XI, point->rhs);
    if (status) return status;
    motion->statistics.solves++;
    zd_motion_solve(motion, point->force, point->rhs, point->vdot, point->lambda);      /* (8), (9), (13) */
    point->known |= ZD_ACCELERATED;
    return ZD_DONE;
}

static void extra_rates(const zd_motion *motion, double *ydot)
{
    for (int i = 0; i < motion->corrections; i++) {
        const zd_active *active = &motion->active[i];
        if (active->extra_size) active->row->extra_rate(motion->point, ydot + motion->formulation_size + active->extra);
    }
}

int zd_motion_rate(void *context, double t, const double *y, double *ydot)
{
    zd_motion *motion = context;
    int status = motion->formulation->enter(motion->solver, motion->point, t, y);
    motion->state = y;
    if (motion->corrections_size) motion->point->known &= ~ZD_ACCELERATED;     /* vdot depends on them, too */
    if (!status) status = zd_motion_accelerate(motion);
    if (!status) status = motion->formulation->rate(motion->solver, motion->point, ydot);
    if (status) return status;
    if (motion->corrections_size) extra_rates(motion, ydot);
    if (motion->balance.input) ydot[motion->rate.size - 1] = zd_motion_power(motion);
    return ZD_DONE;
}
