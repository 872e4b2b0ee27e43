/* Values of constraint rows and generalized forces at one state, with or without a user function. */
#ifndef ZD_COMMON_LAWS_H
#define ZD_COMMON_LAWS_H

#include "planned.h"
#include "readings.h"

/* A row g(t, x) = 0 of (3), or a_i(t, x) xdot_i + a_0(t, x) = 0 of (5). */
typedef struct zd_combined {
    double value;           /* g of a user function; without one: minus the constant part, as the marker quantities are added by the caller */
    double explicit_rate;   /* explicit part of the rate in (5): dg/dt, or a_0 */
    double second;          /* part of (6) that does not contain second derivatives of the marker quantities */
    const double *factors;  /* dg/dx_i, or a_i: (terms,) */
} zd_combined;

/* These return ZD_DONE, or what the user function returns that failed: ZD_NOT_FINITE or ZD_CALLBACK. */
int zd_combine(const zd_planned_elements *elements, const zd_readings *at, const zd_relation *row, double t, zd_combined *all);
/* value <- the generalized force; rate <- the rate of its marker quantity, NULL: not wanted. */
int zd_force_evaluate(const zd_planned_elements *elements, const zd_readings *at, const zd_generalized_force *force, double t,
                      double *value, double *rate);
/* u <- the same with the reactions r that its user function reads; 0 if none has this user function. */
int zd_force_read(const zd_planned_elements *elements, const zd_readings *at, int law, double t, const double *r, double *u);
int zd_forces_power(const zd_planned_elements *elements, const zd_readings *at, double t, double *power);     /* sum over all, for (28) */
/* Potential energy: V of gravity plus the energy stored in springs. */
double zd_springs_potential(const zd_planned_elements *elements, const zd_readings *at, double V);

#endif
