/* Functions of a spatial mechanism's zd_system. */
#pragma once

#include "../../common/actions.h"
#include "../plan.h"

/* For texts that are of the plane and of space: ../../common/..._of_dimension.h. */
#define BODIES(self) (self)->bodies
#define MASS(self, index) (self)->body[index].mass

/* The terms of the equations of motion of a mechanism in space. */

zd_evaluate zd_space_evaluate;

/* Forces along marker quantities: springs, dampers, drives by generalized force, forces and torques. */

/* frame->wrench += wrenches of a force along a marker quantity: add() of zd_actions. */
void zd_space_add_force(const zd_readings *at, void *unused, int index, double force);
/* frame->wrench <- all applied forces on the bodies, without constraint forces. Returns ZD_DONE or ZD_CALLBACK. */
int zd_space_forces_apply(const zd_space *self, const zd_space_frame *frame, double t);
int zd_space_power(const zd_space *self, const zd_space_frame *frame, double t, double *power);     /* sum over all of them, for (28) */
double zd_space_potential(const zd_space *self, const zd_space_frame *frame);

/* Measures of a spatial mechanism. */

/* Evaluator of the outputs in self->elements.output; their self->measures.count descriptions are written to `measure`. */
zd_measures zd_space_measures(const zd_space *self, zd_measure *measure);
/* zd_system.check_domain() */
int zd_space_check_domain(const void *data, double rtol, double atol, double t, const double *p, const double *v, double *scratch);
/* zd_reading.evaluate() */
int zd_space_read(const void *data, int law, double t, const double *p, const double *v, const double *r, int is_same_state, double *u,
                  double *scratch);

/* Reactions of joints in space. */

/* Reaction of a joint: force of the first body on the second at the joint's point of the second body, and torque about that point, in
 * global axes, from a frame that is placed and moving. Includes the joint's drives and damping. Returns ZD_DONE or ZD_CALLBACK. */
int zd_space_joint_reaction(const zd_space *self, const zd_space_frame *frame, int joint, const zd_measured_state *at,
                            zd_space_wrench *reaction);

/* The rows of C: constraints of joints, and relations. */

/* Phi, C, Phi_t and xi of all rows except those of point joints, as far as wanted, from a frame that is placed and moving; C must be zero
 * before. Returns ZD_DONE or ZD_CALLBACK. */
int zd_space_rows_write(const zd_space *self, const zd_space_frame *frame, int want, double t, const zd_terms *out);
/* Second derivative of a marker quantity at vdot = 0; of zd_space, in a moving zd_space_frame. */
double zd_space_bias(const void *mechanism, const void *frame, int quantity);

/* Magnitudes of generalized forces before cancellation: see zd_system. */

/* frame->wrench <- on each body the sum of magnitudes of forces, in force.x, and of moments, in torque.x. Returns ZD_DONE or ZD_CALLBACK. */
int zd_space_force_sizes(const zd_space *self, const zd_space_frame *frame, double t);
/* magnitude (m, 2) <- sizes of the terms of each row for velocities of mass centres, and for angular ones. */
int zd_space_row_sizes(const zd_space *self, const zd_space_frame *frame, double t, double *magnitude);
int zd_space_force_magnitudes(const void *data, const double *inputs, double t, const double *p, const double *v, double *magnitude,
                              double *scratch);
