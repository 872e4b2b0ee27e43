/* Forces along gauges: springs, dampers, drives by effort, forces and torques. */
#ifndef ZD_SPACE_EFFORTS_H
#define ZD_SPACE_EFFORTS_H

#include "plan.h"

/* frame->wrench <- all applied forces on the bodies, without constraint forces. Returns ZD_DONE or ZD_CALLBACK. */
int zd_space_efforts_apply(const zd_space *self, const zd_space_frame *frame, double t);
int zd_space_power(const zd_space *self, const zd_space_frame *frame, double t, double *power);     /* power of the efforts, for (28) */
double zd_space_potential(const zd_space *self, const zd_space_frame *frame);

#endif
