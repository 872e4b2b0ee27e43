/* Forces along gauges: springs, dampers, drives by effort, forces and torques. */
#ifndef ZD_EFFORTS_H
#define ZD_EFFORTS_H

#include "plan.h"

/* value <- the effort at (t, frame); rate <- that of its gauge, NULL: not wanted. Returns ZD_DONE or ZD_CALLBACK. */
int zd_effort_value(const zd_mechanism *self, const zd_frame *frame, const zd_effort *effort, double t, double *value, double *rate);
/* frame->wrench <- all that acts on the bodies but for constraints. */
int zd_efforts_apply(const zd_mechanism *self, const zd_frame *frame, double t);
int zd_efforts_power(const zd_mechanism *self, const zd_frame *frame, double t, double *power);   /* of (28) */
double zd_efforts_potential(const zd_mechanism *self, const zd_frame *frame);

#endif
