/* Forces along gauges: springs, dampers, drives by effort, forces and torques. */
#ifndef ZD_SPACE_EFFORTS_H
#define ZD_SPACE_EFFORTS_H

#include "plan.h"

/* value <- the effort at (t, frame); rate <- that of its gauge, NULL: not wanted. Returns ZD_DONE or ZD_CALLBACK. */
int zd_space_effort_value(const zd_space *self, const zd_frame3 *frame, const zd_effort *effort, double t, double *value, double *rate);
/* frame->wrench <- all that acts on the bodies but for constraints. */
int zd_space_efforts_apply(const zd_space *self, const zd_frame3 *frame, double t);
int zd_space_efforts_power(const zd_space *self, const zd_frame3 *frame, double t, double *power);  /* of (28) */
double zd_space_efforts_potential(const zd_space *self, const zd_frame3 *frame);

#endif
