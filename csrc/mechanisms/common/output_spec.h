/* Measures of the system interface, from their specifications. */
#pragma once

#include "planned.h"

enum { ZD_WRENCH_FORCE = 3, ZD_WRENCH_SIZE = 6 };      /* components of a wrench, unused ones included: a force, then a torque */

typedef struct zd_measured_state {
    double t;
    const double *p, *v, *vdot, *lambda;    /* vdot NULL, for reactions: without inertia and given forces, those of lambda alone */
    int is_of_constraints;      /* 1: given forces at a joint, such as its damping, are left out of its reaction; 2: also separating forces */
    const zd_efforts *efforts;  /* NULL: none */
} zd_measured_state;

/* Numerics of plane or space. `frame` is zd_plane_frame or zd_space_frame. */
typedef struct zd_measure_numerics {
    int forces, torques;        /* components of a force and of a torque */
    void (*place)(const void *mechanism, const void *frame, const double *p);
    void (*move)(const void *mechanism, const void *frame, const double *v);
    double (*bias)(const void *mechanism, const void *frame, int quantity);     /* second derivative of a marker quantity at vdot = 0 */
    /* row (nv,), and the value of the marker quantity, NULL: not wanted */
    void (*write_row)(const void *mechanism, const void *frame, int quantity, double scale, double *row, double *value);
    void (*unit_wrench)(const void *mechanism, const void *frame, int quantity, double *wrench);   /* unit force on the second body */
    /* body (2,) of a marker quantity, and wrench (2, ZD_WRENCH_SIZE) of a unit force on them about their centres of mass */
    void (*unit_wrenches)(const void *mechanism, const void *frame, int quantity, int *body, double *wrench);
    /* Wrench of a joint on its second body, and the vector between its points. Returns ZD_DONE or ZD_CALLBACK. */
    int (*reaction)(const void *mechanism, const void *frame, int joint, const zd_measured_state *at, double *wrench);
    void (*apart)(const void *mechanism, const void *frame, int joint, double *vector);
} zd_measure_numerics;

typedef struct zd_measuring {
    const zd_measure_numerics *numerics;
    const zd_planned_elements *elements;
    const zd_readings *readings;
    int nv, joints;
    double *is_placed, *is_moving;      /* 1 if poses, twists belong to the current state */
    double *is_least, *least;           /* 1 if (m,) multipliers of the least reactions belong to the current state */
    double *row;                        /* (nv,) scratch */
} zd_measuring;

/* Number of components of a measure; a force has `of_forces`, a torque `of_torques`. */
int zd_output_size(const zd_output_spec *measure, int of_forces, int of_torques);
/* measure (count,) <- names, units and sizes of the specified measures. */
void zd_output_list(const zd_planned_elements *elements, int count, int of_forces, int of_torques, zd_measure *measure);
/* True if the measure can be evaluated: vdot and the multipliers (either may be NULL) are given where it needs them. */
int zd_output_is_available(const zd_planned_elements *elements, const zd_output_spec *measure, const double *vdot, const double *lambda);
/* value <- a measure of a generalized force: its value, or its power. */
int zd_output_force(const zd_planned_elements *elements, const zd_readings *at, const zd_output_spec *measure, double t, double *value);
/* force <- constraint force of a relation along the marker quantity of one of its terms, or along its value if `term` is their number;
 * positive where it drives that up. */
int zd_drive_force(const zd_planned_elements *elements, const zd_readings *at, int relation, int term, double t, const double *lambda,
                    double *force);
/* value <- a measure of a relation: this force, or its power. */
int zd_output_drive(const zd_planned_elements *elements, const zd_readings *at, const zd_output_spec *measure, double t, const double *lambda,
                    double *value);

/* Measures of several bodies: sums of marker quantities, with derivatives as of one; and moments about the origin. */

void zd_sum_measure(const zd_measuring *self, const zd_output_spec *measure, const zd_measured_state *at, const zd_measured *out);
void zd_momentum_measure(const zd_measuring *self, const zd_output_spec *measure, const zd_measured_state *at, double *value);

/* Evaluation of measures, common to plane and space: dispatch by kind, on the numerics of either. */

/* As zd_measures.evaluate(). Returns ZD_DONE, ZD_BAD_ARGUMENT or ZD_CALLBACK. */
int zd_measures_evaluate(const zd_measuring *self, int measure, const zd_measured_state *at, const zd_measured *out);
/* As zd_reading.evaluate(). */
int zd_measures_read(const zd_measuring *self, int law, const zd_measured_state *at, const double *r, int is_same_state, double *u);

/* Multipliers of the least reactions, where constraints are redundant. */

/* to (m,) <- multipliers with the same generalized force C^T lambda, for which the sum over all joints and relations of force^2 +
 * (moment / length)^2 is least. The frame is placed and moving. Returns ZD_DONE, ZD_NO_MEMORY or ZD_CALLBACK. */
int zd_least_reactions(const zd_measuring *self, const zd_measured_state *at, double *to);

/* N (m, m) <- `count` redundant multipliers, C^T n = 0, one after another; total <- norm of the weighted wrenches S N. As above. */
int zd_redundant_multipliers(const zd_measuring *self, const zd_measured_state *at, double *N, int *count, double *total);
