/* Forces along gauges: springs, dampers, drives by effort, forces and torques. */
#ifndef ZD_PLANE_EFFORTS_H
#define ZD_PLANE_EFFORTS_H

#include "plan.h"

/* frame->wrench <- all applied forces on the bodies, without constraint forces. Returns ZD_DONE or ZD_CALLBACK. */
int zd_plane_efforts_apply(const zd_plane *self, const zd_plane_frame *frame, double t);
int zd_plane_power(const zd_plane *self, const zd_plane_frame *frame, double t, double *power);     /* power of the efforts, for (28) */
double zd_plane_potential(const zd_plane *self, const zd_plane_frame *frame);

#endif
