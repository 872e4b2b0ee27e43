/* Explicit Runge-Kutta methods: one stepper, and a table of coefficients for each method. */
#ifndef ZD_RUNGE_KUTTA_H
#define ZD_RUNGE_KUTTA_H

#include "integrator.h"

/* Butcher's table, a strictly lower triangular (stages, stages):   c | a
 *                                                                    | b
 * and, for an error estimate h sum e_i k_i, the weights e (stages + 1,): the last is that of f at the end of the step. */
typedef struct zd_tableau {
    int stages;
    const double *a, *b, *c;
    const double *e;        /* NULL: there is none */
    const double *e3;       /* weights of a second estimate that DOP853 blends in; NULL: there is none */
} zd_tableau;

void *zd_runge_kutta_take(zd_arena *arena, const void *table, const zd_system *system, int size, const void *given);
int zd_runge_kutta_step(void *self, const zd_rate *rate, double t, double h, double *y, zd_statistics *statistics);
int zd_runge_kutta_error(void *self, const zd_rate *rate, double t1, double h, const double *y, const double *scale, double *norm,
                         double *lambda_h);

#define ZD_RUNGE_KUTTA(tableau) \
    .table = &(tableau), .take = zd_runge_kutta_take, .step = zd_runge_kutta_step, .error = zd_runge_kutta_error

#endif
