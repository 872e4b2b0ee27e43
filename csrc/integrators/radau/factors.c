#include "iteration.h"

#include <math.h>

#include "../../linalg/dense.h"

/* A power of two above the largest entry of a row of gamma / h - J, so that rows compare */
static double size_of_row(const zd_radau_matrices *self, int i, double h)
{
    int exponent = 0;
    (void)frexp(fmax(zd_max_abs(self->size, self->J + i * self->size), ZD_RADAU_GAMMA / h), &exponent);
    return ldexp(1, exponent);
}

static int factor_real(zd_radau_matrices *self, double h)
{
    const int n = self->size;
    for (int i = 0; i < n; i++) {
        const double share = self->weight[i] = 1 / size_of_row(self, i, h);
        for (int j = 0; j < n; j++) self->real[i * n + j] = -self->J[i * n + j] * share;
        self->real[i * n + i] += ZD_RADAU_GAMMA / h * share;
    }
    return zd_lu_factor(n, self->real, self->real_order) == n;
}

/* After the real one, whose rows are multiplied by the same. */
static int factor_complex(zd_radau_matrices *self, double h)
{
    const int n = self->size;
    for (int i = 0; i < n; i++) {
        const double share = self->weight[i];
        for (int j = 0; j < n; j++) {
            self->re[i * n + j] = -self->J[i * n + j] * share;
            self->im[i * n + j] = 0;
        }
        self->re[i * n + i] += ZD_RADAU_ALPHA / h * share;
        self->im[i * n + i] = -ZD_RADAU_BETA / h * share;
    }
    return zd_complex_lu_factor(n, self->re, self->im, self->complex_order) == n;
}

int zd_radau_factor_real(zd_radau_matrices *self, double h)
{
    if (self->h == h) return ZD_DONE;
    const int is_factored = self->pairs ? zd_radau_pairs_factor_real(self, h) : factor_real(self, h);
    self->h = is_factored ? h : 0;
    self->complex_h = 0;
    return is_factored ? ZD_DONE : ZD_NO_STEP;
}

int zd_radau_factor(zd_radau_matrices *self, double h)
{
    int status = zd_radau_factor_real(self, h);
    if (status || self->complex_h == h) return status;
    const int is_factored = self->pairs ? zd_radau_pairs_factor_complex(self, h) : factor_complex(self, h);
    self->complex_h = is_factored ? h : 0;
    return is_factored ? ZD_DONE : ZD_NO_STEP;
}

/* x <- unit times solution of what has been multiplied by weight and divided by unit */
static void weigh(const zd_radau_matrices *self, double *x)
{
    for (int i = 0; i < self->size; i++) x[i] *= self->weight[i] * self->inverse_unit[i];
}

static void give_units(const zd_radau_matrices *self, double *x)
{
    for (int i = 0; i < self->size; i++) x[i] *= self->differences.unit[i];
}

void zd_radau_solve_real(const zd_radau_matrices *self, double *x)
{
    if (self->pairs) {
        zd_radau_pairs_solve_real(self, x);
        return;
    }
    weigh(self, x);
    zd_lu_solve(self->size, self->real, self->real_order, x);
    give_units(self, x);
}

void zd_radau_solve_complex(const zd_radau_matrices *self, double *x, double *y)
{
    if (self->pairs) {
        zd_radau_pairs_solve_complex(self, x, y);
        return;
    }
    weigh(self, x);
    weigh(self, y);
    zd_complex_lu_solve(self->size, self->re, self->im, self->complex_order, x, y);
    give_units(self, x);
    give_units(self, y);
}
