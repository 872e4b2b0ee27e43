/* Entry of the table of integrators: one step in time. Most use only the rate of an opaque state. */
#pragma once

#include "../motion/motion.h"

typedef struct zd_integrator {
    zd_card card;
    const void *table;      /* coefficients, for methods that share an implementation */
    int takes_series;       /* true if it integrates the Taylor series of the system, without changes of the constraints: zd_series */
    int takes_jacobian;     /* true if it uses rate->jacobian */
    int (*suits)(const zd_system *system);      /* NULL: it suits any system */
    /* y (size,): the state of every step; given: its parameters, in the order of its card */
    void *(*create)(zd_arena *arena, const void *table, zd_motion *motion, double *y, int size, const void *given);
    int (*step)(void *self, const zd_rate *rate, double t, double h, double *y, zd_statistics *statistics);
    /* Replaces step() in methods that solve the constraints within the step. */
    int (*step_of_motion)(void *self, zd_motion *motion, double t, double h, double *y);
    /* Receives the approximate error scale (size,) of the next step. NULL: not needed. */
    void (*set_scale)(void *self, int size, const double *scale);
    /* Receives the tolerances of adaptive steps, once, before the first. NULL: not needed. */
    void (*set_tolerance)(void *self, double rtol, double atol);
    /* h <- the longest step from y at t whose error is at most 1 in units of scale, computed before the step; NULL: not known before. */
    int (*predict_step)(void *self, const zd_rate *rate, double t, const double *y, const double *scale, double *h);
    double decay;           /* with an error estimate: the largest |lambda h| for which y' = lambda y with lambda < 0 decays; 0: any */
    /* Error estimate of the step just made to y at t1, RMS in units of scale, and |lambda h| of the fastest component there, 0: not
     * known. NULL if card.error_order is 0. */
    int (*error)(void *self, const zd_rate *rate, double t1, double h, const double *y, const double *scale, double *norm,
                 double *lambda_h);
    double (*limit_step)(const void *self, double h);  /* best size of the next step, at most h, for the iteration; NULL: h */
    void (*forget)(void *self);     /* the rate has jumped since the last step, which tells nothing of the next; NULL: no step does */
    /* Dense output of the step just made from (t, y0) to (t + h, y1): prepares the polynomial; evaluates it at a fraction of the step.
     * NULL: the method has none, and shorter steps are made instead. */
    int (*prepare_dense)(void *self, const zd_rate *rate, double t, double h, const double *y0, const double *y1);
    void (*dense_output)(const void *self, double share, const double *y0, double *y);
} zd_integrator;

/* True if the method evaluates accelerations, with which reactions are solved that user functions read. */
static inline int zd_evaluates_accelerations(const zd_integrator *self) { return !self->takes_series && !self->step_of_motion; }

/* Implicit methods need dense matrices of the size of the state, so systems with a declared structure may have only this many velocities. */
enum { ZD_MAX_IMPLICIT = 300 };
static inline int zd_is_too_large(const zd_system *system) { return system->structure && system->nv > ZD_MAX_IMPLICIT; }

/* df/dy of a rate by finite differences, for implicit methods, in units that make the entries of a state comparable: for the trapezoidal
 * rule; and for Radau's method where motion/jacobian.c has no derivatives of the rate, which are Baumgarte's terms and the corrections' own
 * entries of the state, states at a bifurcation, and in independent velocities the system's own complement D and large structures. */

typedef struct zd_differences {
    int size;
    double *scale;          /* (size,): largest terms so far in each equation, which has a unit of its own */
    double *unit;           /* (size,): unit of each entry of the matrix, a power of two near its scale when the matrix was made */
    double *varied;         /* (size,): f at a varied y; or increments */
    double min_size;      /* smallest size of y_i assumed for increments: y_i and f_i may be rounding errors only */
} zd_differences;

zd_differences zd_differences_create(zd_arena *arena, int size);
/* Adapts to a state of another size. */
void zd_differences_resize(zd_differences *self, int size);
void zd_differences_choose_units(zd_differences *self);
/* increment (size,) of each entry for a difference along it, of which y + increment - y is exact. */
void zd_differences_increments(const zd_differences *self, const double *y, double *increment);
/* J (size, size) <- share df/dy at (t, y), where f is known, in the units that were chosen: its entry (i, j) times unit_j / unit_i. A
 * state changes by about h f in a step. y is as it was afterwards. */
int zd_differences_make(zd_differences *self, const zd_rate *rate, double t, double h, double share, double *y, const double *f, double *J);
