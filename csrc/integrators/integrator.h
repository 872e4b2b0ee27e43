/* A row of the table of integrators: one step in time. Most know nothing but the rate of an opaque state. */
#ifndef ZD_INTEGRATOR_H
#define ZD_INTEGRATOR_H

#include "../motion/motion.h"

typedef struct zd_integrator {
    zd_card card;
    const void *table;      /* coefficients, for methods that share a stepper */
    int takes_series;       /* whether its steps are those of the system's series, in (p, v) and of the constraints as they are: see zd_series */
    int takes_jacobian;     /* whether it takes rate->jacobian */
    int (*suits)(const zd_system *system);      /* NULL: it takes any */
    /* given: the parameters that its card lists */
    void *(*take)(zd_arena *arena, const void *table, const zd_system *system, int size, const void *given);
    int (*step)(void *self, const zd_rate *rate, double t, double h, double *y, zd_statistics *statistics);
    /* Instead of it, where rates are not enough and a step has constraints and impulses of its own. */
    int (*step_of_motion)(void *self, zd_motion *motion, double t, double h, double *y);
    /* By what the error of the next step will be measured, about: (size,). NULL: it makes no difference to the step. */
    void (*weigh)(void *self, int size, const double *scale);
    /* What is allowed where steps are chosen, once, before the first. NULL: it makes no difference. */
    void (*aim)(void *self, double rtol, double atol);
    /* The longest step from y at t on whose error is allowed, in units of scale, where that is known before it is made; NULL: it is not. */
    int (*foresee)(void *self, const zd_rate *rate, double t, const double *y, const double *scale, double *h);
    double decay;           /* the largest |lambda h| for which y' = lambda y with lambda < 0 decays; 0: any */
    /* The error of the step just made to y at t1, root mean square in units of scale, and |lambda h| of what changes fastest
     * there, 0: not known; NULL where card.error_order is 0. */
    int (*error)(void *self, const zd_rate *rate, double t1, double h, const double *y, const double *scale, double *norm,
                 double *lambda_h);
    double (*fit)(const void *self, double h);  /* the step after the one just made, of at most h, that serves best as its solution goes; NULL: h */
    /* A polynomial between y0 and y1, the ends of the step just made from t to t + h, whose error is that of the method; then its value y
     * at a share of the step. NULL: there is none, and shorter steps lead between. */
    int (*spread)(void *self, const zd_rate *rate, double t, double h, const double *y0, const double *y1);
    void (*between)(const void *self, double share, const double *y0, double *y);
} zd_integrator;

/* Implicit methods have dense matrices of the size of the state: a system with structure, which else has none, may be this large. */
enum { ZD_MOST_IMPLICIT = 300 };    /* velocities */
static inline int zd_is_too_large(const zd_system *system) { return system->structure && system->nv > ZD_MOST_IMPLICIT; }

#endif
