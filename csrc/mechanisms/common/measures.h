/* Evaluation of measures, common to plane and space: dispatch by kind, on the numerics of either. */
#ifndef ZD_COMMON_MEASURES_H
#define ZD_COMMON_MEASURES_H

#include "output_spec.h"

enum { ZD_WRENCH_FORCE = 3, ZD_WRENCH_SIZE = 6 };      /* components of a wrench, unused ones included: a force, then a torque */

typedef struct zd_measured_state {
    double t;
    const double *p, *v, *vdot, *lambda;    /* vdot NULL, for reactions: without inertia and given forces, those of lambda alone */
    int is_of_constraints;      /* 1: given forces at a joint, such as its damping, are left out of its reaction */
} zd_measured_state;

/* Numerics of plane or space. `frame` is zd_plane_frame or zd_space_frame. */
typedef struct zd_measure_numerics {
    int forces, torques;        /* components of a force and of a torque */
    void (*place)(const void *mechanism, const void *frame, const double *p);
    void (*move)(const void *mechanism, const void *frame, const double *v);
    double (*bias)(const void *mechanism, const void *frame, int quantity);     /* second derivative of a marker quantity at vdot = 0 */
    void (*write_row)(const void *mechanism, const void *frame, int quantity, double scale, double *row);      /* (nv,) */
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
    zd_readings readings;
    int nv, joints;
    double *is_placed, *is_moving;      /* 1 if poses, twists belong to the current state */
    double *is_least, *least;           /* 1 if (m,) multipliers of the least reactions belong to the current state */
    double *row;                        /* (nv,) scratch */
} zd_measuring;

/* As zd_measures.evaluate(). Returns ZD_DONE, ZD_BAD_ARGUMENT or ZD_CALLBACK. */
int zd_measures_evaluate(const zd_measuring *self, int measure, const zd_measured_state *at, const zd_measured *out);
/* As zd_reading.evaluate(). */
int zd_measures_read(const zd_measuring *self, int law, const zd_measured_state *at, const double *r, int is_same_state, double *u);

#endif
