/* Values within a step just made, where its method has a polynomial for them. */
#ifndef ZD_SPREAD_H
#define ZD_SPREAD_H

#include "step.h"

/* From the next step on, what that is made in is remembered with where it begins: else there are no values within steps in variables that may
 * be chosen anew at the end. ZD_NO_MEMORY */
int zd_spread_prepare(zd_stepper *stepper);
/* Whether the integrator can say what the state is within the step from t0, which is the one just made; and for that its polynomial, which
 * serves until another step is made. The motion is at the end of the step. */
int zd_may_spread(const zd_stepper *stepper, double t0);
int zd_spread(zd_stepper *stepper);
/* The point at any time within the step, with all corrections, its ends being believed, from the state y (size,) that the integrator says
 * there is. */
int zd_spread_land(zd_stepper *stepper, double t, double *y);

#endif
