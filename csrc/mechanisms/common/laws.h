/* What rows and efforts say at one state: by a law, or without. */
#ifndef ZD_COMMON_LAWS_H
#define ZD_COMMON_LAWS_H

#include "planned.h"
#include "readings.h"

/* A row g(t, x) = 0 of (3), or a_i(t, x) xdot_i + a_0(t, x) = 0 of (5). */
typedef struct zd_combined {
    double value;           /* g, but for the gauges' own part where the row has no law */
    double explicit_rate;   /* of (5): dg/dt, or a_0 */
    double second;          /* what (6) has besides the gauges' own second derivatives */
    const double *factors;  /* dg/dx_i, or a_i: (terms,) */
} zd_combined;

/* These return ZD_DONE or ZD_CALLBACK. */
int zd_combine(const zd_planned_elements *elements, const zd_readings *at, const zd_relation *row, double t, zd_combined *all);
/* value <- the effort; rate <- that of its gauge, NULL: not wanted. */
int zd_effort_say(const zd_planned_elements *elements, const zd_readings *at, const zd_effort *effort, double t, double *value, double *rate);
int zd_efforts_power(const zd_planned_elements *elements, const zd_readings *at, double t, double *power);     /* of (28) */
/* What springs store besides V, which is that of gravity. */
double zd_springs_potential(const zd_planned_elements *elements, const zd_readings *at, double V);

#endif
