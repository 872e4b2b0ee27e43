/* One step of an explicit Runge-Kutta method:
 *
 *     k_i = f(t + c_i h, y + h sum_j a_ij k_j),    y <- y + h sum_i b_i k_i
 */
#include "runge_kutta.h"

#include <math.h>

#include "../linalg/small.h"

static const double ROUNDING = 0x1p-42;     /* of a state: so small a difference of two is what accelerations leave near a bifurcation */
enum { LOOK_EVERY = 32 };    /* steps between looks at stiffness, where these cost an evaluation */

typedef struct runge_kutta {
    const zd_tableau *tableau;
    int size;
    int calls;      /* of the error estimate */
    double *k;      /* (stages, size), and for an error estimate one more */
    double *stage;  /* (size,) */
    double *estimate;   /* (size,): of the error, for each unit of time */
} runge_kutta;

void *zd_runge_kutta_take(zd_arena *arena, const void *table, const zd_system *system, int size, const void *given)
{
    (void)given;
    (void)system;
    const zd_tableau *tableau = table;
    const size_t estimates = tableau->e != NULL;
    runge_kutta self = {
        .tableau = tableau,
        .size = size,
        .k = zd_take_doubles(arena, ((size_t)tableau->stages + estimates) * (size_t)size),
        .stage = zd_take_doubles(arena, (size_t)size),
        .estimate = zd_take_doubles(arena, estimates * (size_t)size),
    };
    return zd_take_filled(arena, &self, sizeof self);
}

/* to <- y + h sum_j weight_j k_j, over the first `stages` of them */
ZD_INLINE void combine(const int size, int stages, const double *weight, double h, const double *k, const double *y, double *to)
{
    for (int i = 0; i < size; i++) to[i] = y[i];
    for (int j = 0; j < stages; j++)
        if (weight[j] != 0) zd_add_scaled(size, to, h * weight[j], k + j * size);
}

int zd_runge_kutta_step(void *memory, const zd_rate *rate, double t, double h, double *y, zd_statistics *statistics)
{
    (void)statistics;
    runge_kutta *self = memory;
    const zd_tableau *T = self->tableau;
    self->size = rate->size;    /* it may have changed */
    for (int i = 0; i < T->stages; i++) {
        ZD_SIZED(combine, self->size, i, T->a + i * T->stages, h, self->k, y, self->stage);
        int status = rate->evaluate(rate->context, t + T->c[i] * h, self->stage, self->k + i * self->size);
        if (status) return status;
    }
    ZD_SIZED(combine, self->size, T->stages, T->b, h, self->k, y, y);
    return ZD_DONE;
}

/* The sum of squares of sum_j weight_j k_j in units of scale */
ZD_INLINE double squares(const int size, const runge_kutta *self, const double *weight, const double *scale)
{
    double sum = 0, *estimate = self->estimate;
    for (int i = 0; i < size; i++) estimate[i] = 0;
    for (int j = 0; j <= self->tableau->stages; j++)
        if (weight[j] != 0) zd_add_scaled(size, estimate, weight[j], self->k + j * size);
    for (int i = 0; i < size; i++) sum += (estimate[i] / scale[i]) * (estimate[i] / scale[i]);
    return sum;
}

/* The last stage is at t1, too, and not far from y: |f(y) - f(stage)| / |y - stage|, of Hairer, Norsett and Wanner's test for
 * stiffness, section IV.2 of their second volume. */
static double lipschitz(const runge_kutta *self, const double *y, const double *scale)
{
    const double *of_stage = self->k + (self->tableau->stages - 1) * self->size, *of_y = of_stage + self->size;
    double rates = 0, states = 0, rounding = 0;
    for (int i = 0; i < self->size; i++) {
        double rate = (of_y[i] - of_stage[i]) / scale[i], state = (y[i] - self->stage[i]) / scale[i];
        rates += rate * rate;
        states += state * state;
        rounding += (ROUNDING * y[i] / scale[i]) * (ROUNDING * y[i] / scale[i]);
    }
    return states > rounding ? sqrt(rates / states) : 0;
}

int zd_runge_kutta_error(void *memory, const zd_rate *rate, double t1, double h, const double *y, const double *scale, double *norm,
                         double *lambda_h)
{
    runge_kutta *self = memory;
    const zd_tableau *T = self->tableau;
    double *last = self->k + T->stages * self->size;
    int needed = T->e[T->stages] != 0, looking = needed || ++self->calls % LOOK_EVERY == 0;
    int status = looking ? rate->evaluate(rate->context, t1, y, last) : ZD_DONE;
    if (status) return status;
    double sum = ZD_SIZED(squares, self->size, self, T->e, scale);
    double blend = T->e3 ? sum + 0.01 * ZD_SIZED(squares, self->size, self, T->e3, scale) : sum;
    *lambda_h = looking && T->c[T->stages - 1] == 1 ? fabs(h) * lipschitz(self, y, scale) : 0;
    *norm = sum > 0 ? fabs(h) * sum / sqrt(blend * self->size) : sum;       /* with e alone: the root mean square */
    return ZD_DONE;
}
