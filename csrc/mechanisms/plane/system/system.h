/* Functions of a planar mechanism's zd_system. */
#pragma once

#include "../../common/actions.h"
#include "../../common/output_spec.h"
#include "../plan.h"

/* For texts that are of the plane and of space: ../../common/..._of_dimension.h. */
#define BODIES(self) (self)->tree.bodies
#define MASS(self, index) (self)->tree.link[index].mass

/* The terms of the equations of motion of a mechanism. */

zd_evaluate zd_plane_evaluate;

/* Forces along marker quantities: springs, dampers, drives by generalized force, forces and torques. */

/* frame->wrench += wrenches of a force along a marker quantity: add() of zd_actions. */
void zd_plane_add_force(const zd_readings *at, void *unused, int index, double force);
/* frame->wrench <- all applied forces on the bodies, without constraint forces. Returns ZD_DONE or ZD_CALLBACK. */
int zd_plane_forces_apply(const zd_plane *self, const zd_plane_frame *frame, double t);
int zd_plane_power(const zd_plane *self, const zd_plane_frame *frame, double t, double *power);     /* sum over all of them, for (28) */
double zd_plane_potential(const zd_plane *self, const zd_plane_frame *frame);

/* The named functions of a mechanism's motion. */

/* Names and sizes of the mechanism's measures, in `measure`. */
zd_measures zd_plane_measures(const zd_plane *self, zd_measure *measure);
/* zd_system.check_domain() */
int zd_plane_check_domain(const void *data, double rtol, double atol, double t, const double *p, const double *v, double *scratch);
/* zd_reading.evaluate() */
int zd_plane_read(const void *data, int law, double t, const double *p, const double *v, const double *r, int is_same_state, double *u,
                  double *scratch);

/* Reactions of joints. */

/* Reaction of a joint: force of the first body on the second at the joint's point of the second body, and torque about that point, from a
 * frame that is placed and moving. Includes the joint's drives and damping. Returns ZD_DONE or ZD_CALLBACK. */
int zd_plane_joint_reaction(const zd_plane *self, const zd_plane_frame *frame, int joint, const zd_measured_state *at,
                            zd_plane_wrench *reaction);

/* The rows of C: constraints of joints, and relations. */

/* Phi, C, Phi_t and xi, as far as they are wanted, from a frame that is placed and moving; C is zero before. Returns ZD_DONE or
 * ZD_CALLBACK. */
int zd_plane_rows_write(const zd_plane *self, const zd_plane_frame *frame, int want, double t, const zd_terms *out);
/* Second derivative of a marker quantity at vdot = 0; of zd_plane, in a moving zd_plane_frame. */
double zd_plane_bias(const void *mechanism, const void *frame, int quantity);
