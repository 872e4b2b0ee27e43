/* Forces along marker quantities: springs, dampers, drives by generalized force, forces and torques. */
#ifndef ZD_SPACE_FORCES_H
#define ZD_SPACE_FORCES_H

#include "../../common/actions.h"
#include "../plan.h"

/* frame->wrench += wrenches of a force along a marker quantity: add() of zd_actions. */
void zd_space_add_force(const zd_readings *at, void *unused, int index, double force);
/* frame->wrench <- all applied forces on the bodies, without constraint forces. Returns ZD_DONE or ZD_CALLBACK. */
int zd_space_forces_apply(const zd_space *self, const zd_space_frame *frame, double t);
int zd_space_power(const zd_space *self, const zd_space_frame *frame, double t, double *power);     /* sum over all of them, for (28) */
double zd_space_potential(const zd_space *self, const zd_space_frame *frame);

#endif
