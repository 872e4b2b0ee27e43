/* Explicit Runge-Kutta methods: one stepper, and a table of coefficients for each method. */
#ifndef ZD_RUNGE_KUTTA_H
#define ZD_RUNGE_KUTTA_H

#include "../core.h"

/* Butcher's table, a strictly lower triangular (stages, stages):   c | a
 *                                                                    | b    */
typedef struct zd_tableau {
    int stages;
    const double *a, *b, *c;
} zd_tableau;

void *zd_runge_kutta_take(zd_arena *arena, const void *table, int size);
int zd_runge_kutta_step(void *self, const zd_rate *rate, double t, double h, double *y, zd_statistics *statistics);

#define ZD_RUNGE_KUTTA(tableau) .table = &(tableau), .take = zd_runge_kutta_take, .step = zd_runge_kutta_step

#endif
