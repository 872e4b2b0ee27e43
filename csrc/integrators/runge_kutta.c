/* One step of an explicit Runge-Kutta method:
 *
 *     k_i = f(t + c_i h, y + h sum_j a_ij k_j),    y <- y + h sum_i b_i k_i
 *
 * The step itself is in the header, as each method has it compiled with its own table.
 */
#include "runge_kutta.h"

void *zd_runge_kutta_create(zd_arena *arena, const void *table, zd_motion *motion, double *y, int size, const void *given)
{
    (void)motion, (void)y, (void)given;
    const zd_tableau *tableau = table;
    const size_t estimates = tableau->e != NULL;
    zd_runge_kutta self = {
        .size = size,
        .k = zd_arena_doubles(arena, ((size_t)(tableau->stages + tableau->more) + estimates) * (size_t)size),
        .stage = zd_arena_doubles(arena, size),
        .change = tableau->coefficients ? zd_arena_doubles(arena, size) : NULL,
    };
    self.end = estimates ? zd_arena_doubles(arena, size) : self.stage;       /* estimates want both */
    return zd_arena_copy(arena, &self, sizeof self);
}

/* The last stage is at t1, too, and not far from y: |f(y) - f(stage)| / |y - stage|, of Hairer, Norsett and Wanner's test for
 * stiffness, section IV.2 of their second volume. */
double zd_runge_kutta_lambda_h(const zd_tableau *T, const zd_runge_kutta *self, double h, const double *y, const double *scale)
{
    const double *of_stage = self->k + (T->stages - 1) * self->size, *of_y = of_stage + self->size;
    double rates = 0, states = 0, rounding = 0;
    if (T->c[T->stages - 1] != 1) return 0;
    for (int i = 0; i < self->size; i++) {
        double rate = (of_y[i] - of_stage[i]) / scale[i], state = (y[i] - self->stage[i]) / scale[i];
        rates += rate * rate;
        states += state * state;
        rounding += (ZD_STATE_ROUNDING * y[i] / scale[i]) * (ZD_STATE_ROUNDING * y[i] / scale[i]);
    }
    return states > rounding ? fabs(h) * sqrt(rates / states) : 0;
}
