/* Newton's matrices of matrices.c where the state is (p, v) with pdot = v, and of its other entries. Of
 *
 *     (mu - J) [x_p; x_v; x_e] = [a; b; c],    J = [[0, 1, 0], [J_p, J_v, 0], [e_p, e_v, 0]]
 *
 * one matrix remains, of half the size: (mu^2 - mu J_v - J_p) x_p = b + (mu - J_v) a, x_v = mu x_p - a, and mu x_e = c + e_p x_p + e_v x_v.
 *
 * All in the units of the differences, in which pdot = s v with a power of two s for each entry; a is divided by it.
 */
#include "iteration.h"

#include <math.h>

#include "../../linalg/dense.h"

/* Size of row i of the matrix: a power of two near its largest entry, for a mu of size 1 / h. */
static double size_of_row(const zd_radau_matrices *self, int i, double mu)
{
    const int n = self->pairs;
    const double *J_p = self->J + (n + i) * self->size, *J_v = J_p + n;
    double largest = mu * mu * self->inverse_slope[i];
    for (int j = 0; j < n; j++) largest = fmax(largest, fmax(fabs(J_p[j]), fabs(J_v[j]) * mu * self->inverse_slope[j]));
    int exponent = 0;
    (void)frexp(largest, &exponent);
    return ldexp(1, exponent);
}

int zd_radau_pairs_factor_real(zd_radau_matrices *self, double h)
{
    const int n = self->pairs;
    const double mu = ZD_RADAU_GAMMA / h;
    for (int i = 0; i < n; i++) {
        const double share = self->weight[i] = 1 / size_of_row(self, i, mu), *J_p = self->J + (n + i) * self->size, *J_v = J_p + n;
        for (int j = 0; j < n; j++) self->real[i * n + j] = -(J_p[j] + mu * self->inverse_slope[j] * J_v[j]) * share;
        self->real[i * n + i] += mu * mu * self->inverse_slope[i] * share;
    }
    return zd_lu_factor(n, self->real, self->real_order) == n;
}

/* Factors the complex matrix of the pairs at mu = (alpha - i beta) / h; its rows have the scales that
 * zd_radau_pairs_factor_real() has computed. */
int zd_radau_pairs_factor_complex(zd_radau_matrices *self, double h)
{
    const int n = self->pairs;
    const double a = ZD_RADAU_ALPHA / h, b = -ZD_RADAU_BETA / h;        /* mu = a + i b */
    for (int i = 0; i < n; i++) {
        const double share = self->weight[i], *J_p = self->J + (n + i) * self->size, *J_v = J_p + n;
        for (int j = 0; j < n; j++) {
            const double by_rate = self->inverse_slope[j] * J_v[j];
            self->re[i * n + j] = -(J_p[j] + a * by_rate) * share;
            self->im[i * n + j] = -b * by_rate * share;
        }
        self->re[i * n + i] += (a * a - b * b) * self->inverse_slope[i] * share;
        self->im[i * n + i] += 2 * a * b * self->inverse_slope[i] * share;
    }
    return zd_complex_lu_factor(n, self->re, self->im, self->complex_order) == n;
}

/* right <- b + (mu - J_v) a for the real part of mu */
static void combine(const zd_radau_matrices *self, double mu, const double *x, double *right)
{
    const int n = self->pairs;
    const double *inverse_unit = self->inverse_unit + n;
    double *a = self->scaled;
    for (int i = 0; i < n; i++) a[i] = x[i] * inverse_unit[i];
    for (int i = 0; i < n; i++) {
        const double *J_v = self->J + (n + i) * self->size + n;
        double sum = x[n + i] * inverse_unit[i] + mu * a[i];
        for (int j = 0; j < n; j++) sum -= J_v[j] * a[j];
        right[i] = sum * self->weight[i];
    }
}

/* mu times the entries of the state after (p, v): x_e <- c + e_p x_p + e_v x_v */
static void follow(const zd_radau_matrices *self, double *x)
{
    const int n = 2 * self->pairs;
    const double *unit = self->differences.unit;
    for (int i = n; i < self->size; i++)
        for (int j = 0; j < n; j++) x[i] += self->J[i * self->size + j] * unit[i] * (x[j] * self->inverse_unit[j]);
}

void zd_radau_pairs_solve_real(const zd_radau_matrices *self, double *x)
{
    const int n = self->pairs;
    const double mu = ZD_RADAU_GAMMA / self->h, *unit = self->differences.unit;
    double *right = self->right;
    combine(self, mu, x, right);
    zd_lu_solve(n, self->real, self->real_order, right);
    for (int i = 0; i < n; i++) {
        const double p = unit[i] * right[i];
        x[n + i] = mu * p - x[i];
        x[i] = p;
    }
    follow(self, x);
    for (int i = 2 * n; i < self->size; i++) x[i] /= mu;
}

void zd_radau_pairs_solve_complex(const zd_radau_matrices *self, double *x, double *y)
{
    const int n = self->pairs;
    const double a = ZD_RADAU_ALPHA / self->h, b = -ZD_RADAU_BETA / self->h, *unit = self->differences.unit;
    double *re = self->right, *im = re + n;
    combine(self, a, x, re);
    combine(self, a, y, im);
    for (int i = 0; i < n; i++) {
        const double by = b * self->inverse_unit[n + i] * self->weight[i];
        re[i] -= by * y[i];
        im[i] += by * x[i];
    }
    zd_complex_lu_solve(n, self->re, self->im, self->complex_order, re, im);
    for (int i = 0; i < n; i++) {
        const double p = unit[i] * re[i], q = unit[i] * im[i];
        x[n + i] = a * p - b * q - x[i];
        y[n + i] = a * q + b * p - y[i];
        x[i] = p;
        y[i] = q;
    }
    follow(self, x);
    follow(self, y);
    const double size = a * a + b * b;
    for (int i = 2 * n; i < self->size; i++) {
        const double p = x[i], q = y[i];
        x[i] = (a * p + b * q) / size;
        y[i] = (a * q - b * p) / size;
    }
}
