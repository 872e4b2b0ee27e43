/* Rigid contacts can bear a load as long as some distribution of it keeps all of them within their bounds. So of all distributions
 *
 *     f = f0 + sum_k z_k n_k,      n_k of the null space of the rows
 *
 * the one is found whose largest |f_i| / bound_i is least: Newton's method with a logarithmic barrier minimizes
 *
 *     s / mu - sum_i log(s bound_i^2 - |f_i|^2)
 *
 * over s and z while mu becomes small; s is then the square of the load factor. */
#include "share.h"

#include <math.h>
#include <string.h>

#include "../linalg/small.h"
#include "equations.h"
#include "problem.h"

static const double MIN_BOUND = 1e-9;       /* smallest bound of a contact, relative to the largest */
static const double PRECISION = 1e-14;      /* relative error of s */
enum { SIZE = 2 * ZD_MAX_PAIRS + 1, STEPS = 200, HALVINGS = 40 };

typedef struct barrier {
    zd_share *of;
    int nulls;
    double null[2 * ZD_MAX_PAIRS * 2 * ZD_MAX_PAIRS];
    double s, mu;
} barrier;

static double slack(const barrier *it, int i)
{
    const double *f = it->of->f + 2 * i;
    return it->s * it->of->bound[i] * it->of->bound[i] - (f[0] * f[0] + f[1] * f[1]);
}

static double value_of(const barrier *it)
{
    double sum = it->s / it->mu;
    for (int i = 0; i < it->of->pairs; i++) {
        const double left = slack(it, i);
        if (!(left > 0)) return INFINITY;
        sum -= log(left);
    }
    return sum;
}

/* Gradient g and Hessian H by z and, as the last one, s. */
static void differentiate(const barrier *it, double *g, double *H)
{
    const int n = it->nulls + 1, width = 2 * it->of->pairs;
    memset(g, 0, n * sizeof *g);
    memset(H, 0, (size_t)n * n * sizeof *H);
    g[n - 1] = 1 / it->mu;
    for (int i = 0; i < it->of->pairs; i++) {
        const double *f = it->of->f + 2 * i, left = slack(it, i);
        double slope[SIZE];     /* gradient of the slack */
        for (int k = 0; k < n - 1; k++)
            slope[k] = -2 * (f[0] * it->null[k * width + 2 * i] + f[1] * it->null[k * width + 2 * i + 1]);
        slope[n - 1] = it->of->bound[i] * it->of->bound[i];
        for (int k = 0; k < n; k++) {
            g[k] -= slope[k] / left;
            for (int j = 0; j < n; j++) H[k * n + j] += slope[k] / left * (slope[j] / left);
        }
        for (int k = 0; k < n - 1; k++)
            for (int j = 0; j < n - 1; j++)
                H[k * n + j] += 2 / left * (it->null[k * width + 2 * i] * it->null[j * width + 2 * i]
                                            + it->null[k * width + 2 * i + 1] * it->null[j * width + 2 * i + 1]);
    }
}

static void move(barrier *it, const double *step, double by)
{
    const int width = 2 * it->of->pairs;
    for (int k = 0; k < it->nulls; k++)
        for (int i = 0; i < width; i++) it->of->f[i] += by * step[k] * it->null[k * width + i];
    it->s += by * step[it->nulls];
}

/* One step of Newton's method, shortened until the value falls; 0: it cannot */
static int improve(barrier *it)
{
    double g[SIZE], H[SIZE * SIZE], L[SIZE * SIZE], before = value_of(it), by = 1;
    const int n = it->nulls + 1;
    differentiate(it, g, H);
    if (zd_cholesky(n, H, L) < n) return 0;
    double slope = 0, step[SIZE];
    for (int k = 0; k < n; k++) step[k] = -g[k];
    zd_forward(n, L, step, step);
    zd_backward(n, L, step, step);
    for (int k = 0; k < n; k++) slope += g[k] * step[k];
    if (!(-slope > 1e-9)) return 0;
    for (int i = 0; i < HALVINGS; i++, by /= 2) {
        zd_share kept = *it->of;
        const double s = it->s;
        move(it, step, by);
        if (value_of(it) < before + 0.1 * by * slope) return 1;
        *it->of = kept, it->s = s;
    }
    return 0;
}

void zd_share_find(zd_share *self, double *K)
{
    barrier it = {.of = self};
    double largest = 0, ratio = 0;
    it.nulls = self->nulls = zd_equations_null_space(2 * self->pairs, K, it.null);
    for (int i = 0; i < self->pairs; i++) largest = fmax(largest, self->bound[i]);
    if (!(largest > 0)) largest = 1e-300;
    for (int i = 0; i < self->pairs; i++) self->bound[i] = fmax(self->bound[i], MIN_BOUND * largest) / largest;
    for (int i = 0; i < 2 * self->pairs; i++) self->f[i] /= largest;
    for (int i = 0; i < self->pairs; i++) ratio = fmax(ratio, hypot(self->f[2 * i], self->f[2 * i + 1]) / self->bound[i]);
    it.s = 2 * ratio * ratio;
    it.mu = it.s;
    for (int i = 0; it.nulls && ratio > 0 && i < STEPS && it.mu > PRECISION * it.s; i++)
        if (!improve(&it)) it.mu /= 8;
    self->factor = 0;
    for (int i = 0; i < self->pairs; i++) {
        const double own = hypot(self->f[2 * i], self->f[2 * i + 1]) / self->bound[i];
        self->factor = fmax(self->factor, own);
        self->weight[i] = it.nulls && ratio > 0 ? it.mu * self->bound[i] * self->bound[i] / slack(&it, i) : own;
    }
    for (int i = 0; i < 2 * self->pairs; i++) self->f[i] *= largest;
    for (int i = 0; i < self->pairs; i++) self->bound[i] *= largest;
}
