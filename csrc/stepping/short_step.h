/* Steps on the closed-form path that end with the projection and, optionally, the energy correction: they work on the state alone, without
 * the general functions of step.c. */
#ifndef ZD_SHORT_STEP_H
#define ZD_SHORT_STEP_H

#include "step_loop.h"

/* True if steps are made this way. The state is then (p, v) with pdot = v, and equals that of the point at the ends of steps. */
static inline int zd_is_short(const zd_motion *motion)
{
    return motion->path.lands && motion->target.every == 1 && motion->rate.direct && !motion->point->terms.A && !motion->system.quaternions;
}

/* Counterparts of zd_stepper_integrate() and zd_passage_land(). */
int zd_short_integrate(zd_step_loop *loop, double h);
int zd_short_land(zd_step_loop *loop, double t1);
/* True if the stepper's state can stay at the end of the step while the point is moved within it. */
static inline int zd_short_may_stay(const zd_stepper *stepper)
{
    return zd_is_short(stepper->motion) && (stepper->motion->point->known & ZD_ACCELERATED);
}
/* Projects a state y within an accepted step and moves the point there; saves and restores accelerations at the end of the step. */
int zd_short_land_between(zd_stepper *stepper, double t, double *y);
void zd_short_keep_rates(const zd_stepper *stepper, zd_cached_accelerations *rates);
void zd_short_return_to_end(zd_stepper *stepper, double t, zd_cached_accelerations *rates);

#endif
