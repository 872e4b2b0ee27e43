/* Steps on the closed-form path that end with the projection and, optionally, the energy correction: they work on the state alone. */
#ifndef ZD_CLOSED_FORM_H
#define ZD_CLOSED_FORM_H

#include "path.h"

extern const zd_equations zd_equations_in_closed_form;      /* rates of states (p, v) */

/* vdot and lambda at the point from `evaluate`, with the terms that corrections add to the right side of (6); NULL: none. */
int zd_closed_form_accelerate(zd_motion *motion, int (*evaluate)(zd_motion *motion, const double *added));
/* Projects p and v at the end t of a step, and computes the point's acceleration there, if path.lands. p and v are the point's own, or the
 * caller copies them there. */
int zd_closed_form_finish(zd_motion *motion, double t, double *p, double *v);
/* True if the stepper's state can stay at the end of the step while the point is moved within it. */
static inline int zd_plain_may_stay(const zd_stepper *stepper)
{
    return stepper->motion->path.is_plain && (stepper->motion->point->known & ZD_ACCELERATED);
}
/* Projects a state y within an accepted step and moves the point there; saves and restores accelerations at the end of the step. */
int zd_plain_project_within(zd_stepper *stepper, double t, double *y);
void zd_plain_save_rates(const zd_stepper *stepper, zd_cached_accelerations *rates);
void zd_plain_return_to_end(zd_stepper *stepper, double t, zd_cached_accelerations *rates);

#endif
