/* Measures as the interface has them, by what they observe. */
#ifndef ZD_COMMON_OUTPUT_SPEC_H
#define ZD_COMMON_OUTPUT_SPEC_H

#include "laws.h"

/* How many components a measure has, where a force has `of_forces` and a torque `of_torques`. */
int zd_output_size(const zd_output_spec *measure, int of_forces, int of_torques);
/* Names and sizes of those that were given, to `measure`. */
void zd_output_list(const zd_planned_elements *elements, int count, int of_forces, int of_torques, zd_measure *measure);
/* Whether vdot and the multipliers are there, if it needs them; both may be NULL. */
int zd_output_is_available(const zd_planned_elements *elements, const zd_output_spec *measure, const double *vdot, const double *lambda);
/* The value of an effort, or its power. */
int zd_output_effort(const zd_planned_elements *elements, const zd_readings *at, const zd_output_spec *measure, double t, double *value);
/* The effort of a relation along the gauge of one of its terms, positive where it drives it up. */
int zd_drive_effort(const zd_planned_elements *elements, const zd_readings *at, int relation, int term, double t, const double *lambda,
                    double *effort);
/* The same of a measure, or its power. */
int zd_output_drive(const zd_planned_elements *elements, const zd_readings *at, const zd_output_spec *measure, double t, const double *lambda,
                      double *value);

#endif
