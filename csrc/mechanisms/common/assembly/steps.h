/* Iterations of an assembly: Newton's method, least squares, continuation, and the nearest positions. Each changes p (nq,). */
#ifndef ZD_ASSEMBLY_STEPS_H
#define ZD_ASSEMBLY_STEPS_H

#include "conditions.h"

#define ZD_CLOSED 1e-12         /* relative to the size of a constraint: largest residual of a closed joint */

/* Minimum-norm Newton steps until the residual stops decreasing; returns whether the conditions are met. */
int zd_assembly_newton(zd_assembly *self, const zd_conditions *of, double *p);
/* The Levenberg-Marquardt method, completed by Newton steps; returns the largest residual that remains. */
double zd_assembly_least_squares(zd_assembly *self, const zd_conditions *of, double *p);
/* Positions nearest to self->drawn on the branch of p, which meets the conditions, by the Gauss-Newton method */
void zd_assembly_approach_drawing(zd_assembly *self, const zd_conditions *of, double *p);
/* Leads drives, couplings and targets from where they are to where they must be in small steps on one branch; returns whether they arrive.
 * Otherwise p is where they were led. */
int zd_assembly_track(zd_assembly *self, int roles, double *p);
/* Approaches the targets of the roles `wished` as nearly as all constraints and the targets of the roles `required` allow. */
void zd_assembly_approach(zd_assembly *self, int required, int wished, double *p);
/* Perturbs p slightly, with closed joints if possible. */
void zd_assembly_perturb(zd_assembly *self, double *p);

#endif
