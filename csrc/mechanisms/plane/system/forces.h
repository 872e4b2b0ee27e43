/* Forces along marker quantities: springs, dampers, drives by generalized force, forces and torques. */
#ifndef ZD_PLANE_FORCES_H
#define ZD_PLANE_FORCES_H

#include "../../common/actions.h"
#include "../plan.h"

/* frame->wrench += wrenches of a force along a marker quantity: add() of zd_actions. */
void zd_plane_add_force(const zd_readings *at, void *unused, int index, double force);
/* frame->wrench <- all applied forces on the bodies, without constraint forces. Returns ZD_DONE or ZD_CALLBACK. */
int zd_plane_forces_apply(const zd_plane *self, const zd_plane_frame *frame, double t);
int zd_plane_power(const zd_plane *self, const zd_plane_frame *frame, double t, double *power);     /* sum over all of them, for (28) */
double zd_plane_potential(const zd_plane *self, const zd_plane_frame *frame);

#endif
