/* Explicit Runge-Kutta methods: one stepper, and a table of coefficients for each method, which the compiler knows where it is used. */
#pragma once

#include <math.h>

#include "../linalg/small.h"
#include "../step_limits.h"
#include "integrator.h"

enum { ZD_MAX_STAGES = 16 };   /* largest number of rates of a method, including those at the end of a step and for dense output */

/* Butcher's table, a strictly lower triangular (stages, stages):   c | a
 *                                                                    | b
 * and, for an error estimate h sum e_i k_i, the weights e (stages + 1,): the last is that of f at the end of the step. */
typedef struct zd_tableau {
    int stages;
    const double *a, *b, *c;
    const double *e;        /* NULL: there is none */
    const double *e3;       /* weights of a second estimate that DOP853 blends in; NULL: there is none */
    int more;               /* additional stages for dense output */
    int coefficients;       /* vectors of its polynomial, at least three; 0: the method has none */
    const double *more_a, *more_c, *d;      /* (more, all), (more,), (coefficients - 3, all), all of them being stages + 1 + more */
} zd_tableau;

typedef struct zd_runge_kutta {
    int size;
    int calls;      /* number of error estimates so far */
    double *k;      /* (stages, size): rates; one more for an error estimate, and those for dense output */
    double *stage, *end;    /* (size,): the last stage, the end of the step; the same array if no error is estimated */
    double h, *change;      /* size of the step; (size,): change of the state in it, for dense output */
} zd_runge_kutta;

/* A loop over stages, of which there are at most 13: written out, so that weights are constants, and those that are zero take no time. */
#if defined(__clang__)
#define ZD_UNROLL _Pragma("clang loop unroll(full)")
#elif defined(__GNUC__)
#define ZD_UNROLL _Pragma("GCC unroll 16")
#else
#define ZD_UNROLL
#endif

/* to <- y + h sum_j weight_j k_j, over the first `terms` of them, from one entry to another */
ZD_INLINE void zd_combine_some(int begin, int end, const int size, const int terms, const double *weight, double h,
                               const double *restrict k, const double *restrict y, double *restrict to)
{
    for (int i = begin; i < end; i++) {
        double sum = y[i];
        ZD_UNROLL
        for (int j = 0; j < terms; j++)
            if (weight[j] != 0) sum += (h * weight[j]) * k[j * size + i];
        to[i] = sum;
    }
}

/* In (p, v), the positions of a stage do not wait for the acceleration of the one before:
 * so none is computed in one vector with a velocity. */
ZD_INLINE void zd_combine(const int positions, const int size, const int terms, const double *weight, double h, const double *k,
                          const double *y, double *to)
{
    zd_combine_some(0, positions, size, terms, weight, h, k, y, to);
    zd_combine_some(positions, size, size, terms, weight, h, k, y, to);
}

ZD_INLINE double zd_combined(int i, const int size, const int terms, const double *weight, double h, const double *k, const double *y)
{
    double sum = y[i];
    ZD_UNROLL
    for (int j = 0; j < terms; j++)
        if (weight[j] != 0) sum += (h * weight[j]) * k[j * size + i];
    return sum;
}

/* n of these entries, the first being `begin`, also to `copy` */
ZD_INLINE void zd_combine_pairs(const int begin, const int n, const int size, const int terms, const double *weight, double h,
                                const double *k, const double *y, double *to, double *copy)
{
    ZD_UNROLL
    for (int i = 0; i + 1 < n; i += 2) {
        double a = zd_combined(begin + i, size, terms, weight, h, k, y), b = zd_combined(begin + i + 1, size, terms, weight, h, k, y);
        zd_store_pair(a, b, to + begin + i);
        if (copy) zd_store_pair(a, b, copy + i);
    }
    if (n % 2 == 0) return;
    to[begin + n - 1] = zd_combined(begin + n - 1, size, terms, weight, h, k, y);
    if (copy) copy[n - 1] = to[begin + n - 1];
}

/* Step of a state (p, v) with n coordinates, pdot = v, and accelerations by a closed-form function alone. */
ZD_INLINE int zd_runge_kutta_closed_form_step(const int n, const zd_tableau *T, const zd_runge_kutta *self, const zd_rate *rate, double t,
                                         double h, double *y)
{
    const zd_system *system = rate->system;
    double *k = self->k, *stage = self->stage;
    int status = zd_rate_of_beginning(rate, t, y, k);
    ZD_UNROLL
    for (int i = 1; i < T->stages; i++) {
        double *rates = k + i * 2 * n;
        const double of_stage = t + T->c[i] * h;
        if (status) return status;
        zd_combine_pairs(0, n, 2 * n, i, T->a + i * T->stages, h, k, y, stage, NULL);
        zd_combine_pairs(n, n, 2 * n, i, T->a + i * T->stages, h, k, y, stage, rates);
        status = rate->closed_form->accelerate(rate->closed_form, system->data, rate->inputs, &of_stage, stage, stage + n, NULL, NULL,
                                               rates + n, NULL, NULL, NULL);
    }
    if (status) return ZD_CALLBACK;
    zd_combine_pairs(0, n, 2 * n, T->stages, T->b, h, k, y, y, NULL);
    zd_combine_pairs(n, n, 2 * n, T->stages, T->b, h, k, y, y, NULL);
    return ZD_DONE;
}

ZD_INLINE int zd_runge_kutta_any_step(const zd_tableau *T, zd_runge_kutta *self, const zd_rate *rate, double t, double h, double *y)
{
    const int size = rate->size, positions = rate->closed_form ? rate->system->nq : 0;
    double *k = self->k, *stage = self->stage;
    int status = zd_rate_of_beginning(rate, t, y, k);
    ZD_UNROLL
    for (int i = 1; i < T->stages; i++) {
        if (status) return status;
        zd_combine(positions, size, i, T->a + i * T->stages, h, k, y, stage);
        status = zd_rate_of_stage(rate, t + T->c[i] * h, stage, k + i * size);
    }
    if (status) return status;
    zd_combine(positions, size, T->stages, T->b, h, k, y, self->end);
    zd_copy(positions, self->end, y);
    zd_copy(size - positions, self->end + positions, y + positions);
    return ZD_DONE;
}

ZD_INLINE int zd_runge_kutta_step(const zd_tableau *T, zd_runge_kutta *self, const zd_rate *rate, double t, double h, double *y)
{
    self->size = rate->size;        /* it may have changed */
    const int is_plain = rate->closed_form && !(rate->system->provides & ZD_A);
    return is_plain ? ZD_SIZED(zd_runge_kutta_closed_form_step, rate->system->nv, T, self, rate, t, h, y)
                    : zd_runge_kutta_any_step(T, self, rate, t, h, y);
}

/* The sum of squares of sum_j weight_j k_j in units of scale */
ZD_INLINE double zd_squares(const int terms, const double *weight, const zd_runge_kutta *self, const double *scale)
{
    double squares = 0;
    for (int i = 0; i < self->size; i++) {
        double sum = 0;
        ZD_UNROLL
        for (int j = 0; j < terms; j++)
            if (weight[j] != 0) sum += weight[j] * self->k[j * self->size + i];
        squares += (sum / scale[i]) * (sum / scale[i]);
    }
    return squares;
}

void *zd_runge_kutta_create(zd_arena *arena, const void *table, zd_motion *motion, double *y, int size, const void *given);
/* |lambda h| at the end of a step whose last stage is there, too; 0: not known */
double zd_runge_kutta_lambda_h(const zd_tableau *T, const zd_runge_kutta *self, double h, const double *y, const double *scale);

ZD_INLINE int zd_runge_kutta_error(const zd_tableau *T, zd_runge_kutta *self, const zd_rate *rate, double t1, double h, const double *y,
                                   const double *scale, double *norm, double *lambda_h)
{
    const int looking = T->e[T->stages] != 0 || ++self->calls % ZD_CHECK_STIFFNESS_EVERY == 0;
    int status = looking ? rate->evaluate(rate->context, t1, y, self->k + T->stages * self->size) : ZD_DONE;
    if (status) return status;
    double sum = zd_squares(T->stages + 1, T->e, self, scale);
    double blend = T->e3 ? sum + 0.01 * zd_squares(T->stages + 1, T->e3, self, scale) : sum;
    *lambda_h = looking ? zd_runge_kutta_lambda_h(T, self, h, y, scale) : 0;
    *norm = sum > 0 ? fabs(h) * sum / sqrt(blend * self->size) : sum;       /* with e alone: the root mean square */
    return ZD_DONE;
}

/* The functions of a method whose table is `tableau`; behind them stands what of its descriptor is the same for all. */
#define ZD_RUNGE_KUTTA_STEP                                                                                                 \
    static int step(void *self, const zd_rate *rate, double t, double h, double *y, zd_statistics *statistics)              \
    {                                                                                                                       \
        if (rate->closed_form) statistics->evaluations += tableau.stages - 1;                                                    \
        return zd_runge_kutta_step(&tableau, self, rate, t, h, y);                                                          \
    }
#define ZD_RUNGE_KUTTA_ERROR                                                                                                \
    static int error(void *self, const zd_rate *rate, double t1, double h, const double *y, const double *scale,            \
                     double *norm, double *lambda_h)                                                                        \
    {                                                                                                                       \
        return zd_runge_kutta_error(&tableau, self, rate, t1, h, y, scale, norm, lambda_h);                                 \
    }
#define ZD_RUNGE_KUTTA .table = &tableau, .create = zd_runge_kutta_create, .step = step
