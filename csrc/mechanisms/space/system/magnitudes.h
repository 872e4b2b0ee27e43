/* Magnitudes of generalized forces before cancellation: see zd_system. */
#ifndef ZD_SPACE_MAGNITUDES_H
#define ZD_SPACE_MAGNITUDES_H

#include "../plan.h"

/* frame->wrench <- on each body the sum of magnitudes of forces, in force.x, and of moments, in torque.x. Returns ZD_DONE or ZD_CALLBACK. */
int zd_space_force_sizes(const zd_space *self, const zd_space_frame *frame, double t);
int zd_space_force_magnitudes(const void *data, const double *inputs, double t, const double *p, const double *v, double *magnitude,
                              double *scratch);

#endif
