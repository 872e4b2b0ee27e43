#include "radau_matrices.h"

#include <math.h>

#include "../linalg/complex_lu.h"
#include "../linalg/lu.h"
#include "../linalg/norms.h"

zd_radau_matrices zd_radau_matrices_take(zd_arena *arena, int size)
{
    const size_t n = (size_t)size;
    return (zd_radau_matrices){
        .size = size,
        .differences = zd_differences_take(arena, size),
        .J = zd_take_doubles(arena, n * n),
        .real = zd_take_doubles(arena, n * n),
        .re = zd_take_doubles(arena, n * n),
        .im = zd_take_doubles(arena, n * n),
        .weight = zd_take_doubles(arena, n),
        .real_order = zd_take(arena, n * sizeof(int)),
        .complex_order = zd_take(arena, n * sizeof(int)),
    };
}

void zd_radau_matrices_resize(zd_radau_matrices *self, int size)
{
    self->size = size;
    self->has_J = 0;
    self->h = 0;
    zd_differences_resize(&self->differences, size);
}

/* From the rate's own derivatives, where they are known. */
static int take_J(zd_radau_matrices *self, const zd_rate *rate, double t, const double *y)
{
    const int n = self->size;
    const double *unit = self->differences.unit;
    int status = rate->jacobian(rate->context, t, y, self->J);
    if (status) return status;
    zd_differences_choose_units(&self->differences);
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++) self->J[i * n + j] *= unit[j] / unit[i];
    return ZD_DONE;
}

int zd_radau_make_J(zd_radau_matrices *self, const zd_rate *rate, double t, double h, double *y, const double *f)
{
    int status = rate->jacobian ? take_J(self, rate, t, y) : ZD_SINGULAR;
    if (status) status = zd_differences_make(&self->differences, rate, t, h, 1, y, f, self->J);
    self->has_J = !status;
    self->h = 0;
    return status;
}

/* A power of two above the largest entry of a row of gamma / h - J, so that rows compare */
static double size_of_row(const zd_radau_matrices *self, int i, double h)
{
    int exponent = 0;
    (void)frexp(fmax(zd_max_abs(self->size, self->J + i * self->size), ZD_RADAU_GAMMA / h), &exponent);
    return ldexp(1, exponent);
}

int zd_radau_factor(zd_radau_matrices *self, double h)
{
    const int n = self->size;
    for (int i = 0; i < n; i++) {
        const double share = 1 / size_of_row(self, i, h);
        for (int j = 0; j < n; j++) {
            self->real[i * n + j] = self->re[i * n + j] = -self->J[i * n + j] * share;
            self->im[i * n + j] = 0;
        }
        self->real[i * n + i] += ZD_RADAU_GAMMA / h * share;
        self->re[i * n + i] += ZD_RADAU_ALPHA / h * share;
        self->im[i * n + i] = -ZD_RADAU_BETA / h * share;
        self->weight[i] = share / self->differences.unit[i];
    }
    const int is_factored = zd_lu_factor(n, self->real, self->real_order) == n
                         && zd_complex_lu_factor(n, self->re, self->im, self->complex_order) == n;
    self->h = is_factored ? h : 0;
    return is_factored ? ZD_DONE : ZD_NO_STEP;
}

static void multiply(int n, const double *by, double *x)
{
    for (int i = 0; i < n; i++) x[i] *= by[i];
}

void zd_radau_solve_real(const zd_radau_matrices *self, double *x)
{
    multiply(self->size, self->weight, x);
    zd_lu_solve(self->size, self->real, self->real_order, x);
    multiply(self->size, self->differences.unit, x);
}

void zd_radau_solve_complex(const zd_radau_matrices *self, double *x, double *y)
{
    multiply(self->size, self->weight, x);
    multiply(self->size, self->weight, y);
    zd_complex_lu_solve(self->size, self->re, self->im, self->complex_order, x, y);
    multiply(self->size, self->differences.unit, x);
    multiply(self->size, self->differences.unit, y);
}
