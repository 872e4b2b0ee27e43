/* Dense output within the last step, if its method has a polynomial. */
#ifndef ZD_SPREAD_H
#define ZD_SPREAD_H

#include "stepper.h"

/* Allocates the copy of the formulation's choice of variables that values within a step need where that choice may change at its end. To be
 * called before the first step. ZD_NO_MEMORY */
int zd_spread_prepare(zd_stepper *stepper);
/* The first: true if there is a polynomial for the last step, from t0. The second prepares it, with the motion at the end of the step; it
 * is valid until the next step. */
int zd_may_spread(const zd_stepper *stepper, double t0);
int zd_spread(zd_stepper *stepper);
/* Moves the point to time t within the step: the value of the polynomial, with all corrections. y (size,) receives the state there. */
int zd_spread_land(zd_stepper *stepper, double t, double *y);

#endif
