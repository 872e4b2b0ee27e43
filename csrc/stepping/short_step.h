/* Steps on the direct road at the ends of which only the projection is made, and the energy may be corrected: they go from the state to the
 * state without detours. */
#ifndef ZD_SHORT_STEP_H
#define ZD_SHORT_STEP_H

#include "step_loop.h"

/* Whether steps are made so. Its state is p and v, of as many entries, and they are those of the point. */
static inline int zd_is_short(const zd_motion *motion)
{
    return motion->path.lands && motion->target.every == 1 && motion->rate.direct && !motion->point->terms.A && !motion->system.quaternions;
}

/* What zd_stepper_integrate() and zd_passage_land() do of any step. */
int zd_short_integrate(zd_step_loop *loop, double h);
int zd_short_land(zd_step_loop *loop, double t1);
/* Whether the stepper's state may stay at the end of the step, with all that is known there, while the point is elsewhere within. */
static inline int zd_short_may_stay(const zd_stepper *stepper)
{
    return zd_is_short(stepper->motion) && (stepper->motion->point->known & ZD_ACCELERATED);
}
/* The point to where a state y of such a step is, between ends that are believed; and back to the end, with what is kept there. */
int zd_short_land_between(zd_stepper *stepper, double t, double *y);
void zd_short_keep_rates(const zd_stepper *stepper, zd_cached_accelerations *rates);
void zd_short_return_to_end(zd_stepper *stepper, double t, zd_cached_accelerations *rates);

#endif
