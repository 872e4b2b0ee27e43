/* Steps on the direct road at the ends of which only the projection is made, and the energy may be corrected: they go from the state to the
 * state without detours. */
#ifndef ZD_SHORT_STEP_H
#define ZD_SHORT_STEP_H

#include "course.h"

/* Whether steps are made so. Its state is p and v, of as many entries, and they are those of the point. */
static inline int zd_is_short(const zd_motion *motion)
{
    return motion->road.lands && motion->hold.every == 1 && motion->rate.direct && !motion->point->terms.A && !motion->system.quaternions;
}

/* What zd_stepper_integrate() and zd_passage_land() do of any step. */
int zd_short_integrate(zd_course *course, double h);
int zd_short_land(zd_course *course, double t1);
/* Where the state within such a step is, between ends that are believed. */
int zd_short_land_between(zd_stepper *stepper, double t);

#endif
