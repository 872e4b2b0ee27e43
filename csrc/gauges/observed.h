/* Measures as the interface has them, by what they observe. */
#ifndef ZD_OBSERVED_H
#define ZD_OBSERVED_H

#include "laws.h"

/* How many components a measure has, where a force has `of_forces` and a torque `of_torques`. */
int zd_observed_size(const zd_observed *measure, int of_forces, int of_torques);
/* Names and sizes of those that were given, to `measure`. */
void zd_observed_list(const zd_planned_uses *uses, int count, int of_forces, int of_torques, zd_measure *measure);
/* Whether vdot and the multipliers are there, if it needs them; both may be NULL. */
int zd_observed_suffices(const zd_planned_uses *uses, const zd_observed *measure, const double *vdot, const double *lambda);
/* The value of an effort, or its power. */
int zd_observed_effort(const zd_planned_uses *uses, const zd_readings *at, const zd_observed *measure, double t, double *value);
/* The effort of a relation along the gauge of one of its terms, positive where it drives it up. */
int zd_drive_effort(const zd_planned_uses *uses, const zd_readings *at, int relation, int term, double t, const double *lambda,
                    double *effort);
/* The same of a measure, or its power. */
int zd_observed_drive(const zd_planned_uses *uses, const zd_readings *at, const zd_observed *measure, double t, const double *lambda,
                      double *value);

#endif
