/* Dense output within the last step, if its method has a polynomial. */
#ifndef ZD_DENSE_OUTPUT_H
#define ZD_DENSE_OUTPUT_H

#include "stepper.h"

/* Allocates the copy of the formulation's choice of variables that values within a step need where that choice may change at its end. To be
 * called before the first step. ZD_NO_MEMORY */
int zd_dense_output_create(zd_stepper *stepper);
/* The first: true if there is a polynomial for the last step, from t0. The second prepares it, with the motion at the end of the step; it
 * is valid until the next step. */
int zd_has_dense_output(const zd_stepper *stepper, double t0);
int zd_dense_output_prepare(zd_stepper *stepper);
/* Moves the point to time t within the step: the value of the polynomial, with all corrections. y (size,) receives the state there. */
int zd_dense_output_move(zd_stepper *stepper, double t, double *y);

#endif
