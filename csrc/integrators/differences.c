#include "integrator.h"

#include <math.h>

#include "../linalg/small.h"

zd_differences zd_differences_create(zd_arena *arena, int size)
{
    const size_t n = size;
    return (zd_differences){
        .size = size,
        .scale = zd_arena_doubles(arena, n),
        .unit = zd_arena_doubles(arena, n),
        .varied = zd_arena_doubles(arena, n),
    };
}

void zd_differences_resize(zd_differences *self, int size)
{
    self->size = size;
    zd_clear(size, self->scale);
}

/* Increment of y_i for a difference: about the square root of the rounding error of its size, also if y_i is zero. */
static double increment(const zd_differences *self, int i, double y, double change)
{
    double size = fmax(fabs(y), fmax(fabs(change), fmax(self->scale[i], self->min_size)));
    return 0x1p-26 * (size > 0 ? size : 1);
}

void zd_differences_increments(const zd_differences *self, const double *y, double *increment_of)
{
    for (int i = 0; i < self->size; i++) {
        const volatile double varied = y[i] + increment(self, i, y[i], 0);
        increment_of[i] = varied - y[i];
    }
}

void zd_differences_choose_units(zd_differences *self)
{
    for (int i = 0; i < self->size; i++) {
        int exponent = 0;
        double size = fmax(self->scale[i], self->min_size);
        if (size > 0 && size < INFINITY) (void)frexp(size, &exponent);
        self->unit[i] = ldexp(1, exponent);
    }
}

int zd_differences_make(zd_differences *self, const zd_rate *rate, double t, double h, double share, double *y, const double *f, double *J)
{
    const int n = self->size;
    for (int j = 0; j < n; j++) {
        const double here = y[j];
        y[j] = here + increment(self, j, here, h * f[j]);
        const double change = y[j] - here;
        int status = rate->evaluate(rate->context, t, y, self->varied);
        y[j] = here;
        if (status) return status;
        for (int i = 0; i < n; i++) J[i * n + j] = share * (self->varied[i] - f[i]) / change * (self->unit[j] / self->unit[i]);
    }
    return ZD_DONE;
}
