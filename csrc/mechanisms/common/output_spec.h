/* Measures of the system interface, from their specifications. */
#ifndef ZD_COMMON_OUTPUT_SPEC_H
#define ZD_COMMON_OUTPUT_SPEC_H

#include "laws.h"

/* Number of components of a measure; a force has `of_forces`, a torque `of_torques`. */
int zd_output_size(const zd_output_spec *measure, int of_forces, int of_torques);
/* measure (count,) <- names, units and sizes of the specified measures. */
void zd_output_list(const zd_planned_elements *elements, int count, int of_forces, int of_torques, zd_measure *measure);
/* True if the measure can be evaluated: vdot and the multipliers (either may be NULL) are given where it needs them. */
int zd_output_is_available(const zd_planned_elements *elements, const zd_output_spec *measure, const double *vdot, const double *lambda);
/* value <- a measure of a generalized force: its value, or its power. */
int zd_output_force(const zd_planned_elements *elements, const zd_readings *at, const zd_output_spec *measure, double t, double *value);
/* force <- constraint force of a relation along the marker quantity of one of its terms, positive where it drives that quantity up. */
int zd_drive_force(const zd_planned_elements *elements, const zd_readings *at, int relation, int term, double t, const double *lambda,
                    double *force);
/* value <- a measure of a relation: this force, or its power. */
int zd_output_drive(const zd_planned_elements *elements, const zd_readings *at, const zd_output_spec *measure, double t, const double *lambda,
                    double *value);

#endif
