#include "iteration.h"

zd_radau_matrices zd_radau_matrices_create(zd_arena *arena, int size)
{
    const size_t n = size;
    return (zd_radau_matrices){
        .size = size,
        .differences = zd_differences_create(arena, size),
        .inverse_unit = zd_arena_doubles(arena, n),
        .inverse_slope = zd_arena_doubles(arena, n),
        .J = zd_arena_doubles(arena, n * n),
        .real = zd_arena_doubles(arena, n * n),
        .re = zd_arena_doubles(arena, n * n),
        .im = zd_arena_doubles(arena, n * n),
        .weight = zd_arena_doubles(arena, n),
        .real_order = zd_arena_ints(arena, n),
        .complex_order = zd_arena_ints(arena, n),
        .scaled = zd_arena_doubles(arena, n),
        .right = zd_arena_doubles(arena, n),
    };
}

void zd_radau_matrices_resize(zd_radau_matrices *self, int size, int pairs)
{
    self->size = size;
    self->pairs = pairs;
    self->has_J = 0;
    self->h = self->complex_h = 0;
    zd_differences_resize(&self->differences, size);
}

/* From the rate's own derivatives, where they are known. */
static int take_J(zd_radau_matrices *self, const zd_rate *rate, double t, const double *y, double *J)
{
    const int n = self->size;
    const double *unit = self->differences.unit;
    double *increment = self->differences.varied;
    zd_differences_increments(&self->differences, y, increment);
    int status = rate->jacobian(rate->context, t, y, increment, J);
    if (status) return status;
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++) J[i * n + j] *= unit[j] * self->inverse_unit[i];
    return ZD_DONE;
}

int zd_radau_evaluate_J(zd_radau_matrices *self, const zd_rate *rate, double t, double h, double *y, double *f, int knows_f, double *J)
{
    int status = rate->jacobian ? take_J(self, rate, t, y, J) : ZD_SINGULAR;
    if (!status || status == ZD_CALLBACK) return status;
    status = knows_f ? ZD_DONE : rate->evaluate(rate->context, t, y, f);
    return status ? status : zd_differences_make(&self->differences, rate, t, h, 1, y, f, J);
}

int zd_radau_make_J(zd_radau_matrices *self, const zd_rate *rate, double t, double h, double *y, double *f)
{
    zd_differences_choose_units(&self->differences);
    for (int i = 0; i < self->size; i++) self->inverse_unit[i] = 1 / self->differences.unit[i];
    for (int i = 0; i < self->pairs; i++) self->inverse_slope[i] = self->differences.unit[i] * self->inverse_unit[self->pairs + i];
    int status = zd_radau_evaluate_J(self, rate, t, h, y, f, 1, self->J);
    self->has_J = !status;
    self->h = self->complex_h = 0;
    return status;
}
