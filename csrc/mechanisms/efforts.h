/* Forces along gauges: springs, dampers, drives by effort, forces and torques. */
#ifndef ZD_EFFORTS_H
#define ZD_EFFORTS_H

#include "plan.h"

/* frame->wrench <- all that acts on the bodies but for constraints. Returns ZD_DONE or ZD_CALLBACK. */
int zd_efforts_apply(const zd_mechanism *self, const zd_frame *frame, double t);
int zd_mechanism_power(const zd_mechanism *self, const zd_frame *frame, double t, double *power);     /* of (28) */
double zd_mechanism_potential(const zd_mechanism *self, const zd_frame *frame);

#endif
