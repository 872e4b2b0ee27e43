/* Rigid contacts hold as long as some distribution of their forces does. So of all distributions
 *
 *     y = y0 + sum_k z_k n_k,      n_k of the null space of their rows
 *
 * the one is found in which the smallest friction N_i - |f_i| is largest. Newton's method with the logarithmic barrier of these cones
 * minimizes
 *
 *     -t / mu - sum_i log((friction N_i - t)^2 - |f_i|^2) - log(T - t) + |y|^2 / (2 unit^2)
 *
 * over t and z while mu becomes small. T and the square bound t and y where contacts may be pressed against each other without limit.
 */
#include "distribution.h"

#include <math.h>
#include <string.h>

#include "../linalg/roots.h"
#include "../linalg/small.h"
#include "equations.h"

static const double PRECISION = 1e-13;      /* error of t, in units of the forces */
static const double UNBOUNDED = 10;         /* T, in the same units */
enum { SIZE = ZD_MAX_FREE + 1, STEPS = 1000 };

typedef struct barrier {
    zd_distribution *of;
    const double *null;     /* (nulls, 3 contacts) */
    double unit, t, mu;
} barrier;

/* Bound of a contact's friction and, without any, its normal force; a coefficient of 0 counts as 1 there. */
static double coefficient(const barrier *it, int i) { return it->of->friction[i] > 0 ? it->of->friction[i] : 1; }
static double room(const barrier *it, int i) { return coefficient(it, i) * it->of->force[3 * i] - it->t; }

static double slack(const barrier *it, int i)
{
    const double *f = it->of->force + 3 * i + 1, left = room(it, i);
    return left > 0 ? left * left - (f[0] * f[0] + f[1] * f[1]) : -1;
}

/* Gradient g and Hessian H by z and, as the last one, t. */
static void differentiate(const barrier *it, double *g, double *H)
{
    const int nulls = it->of->nulls, n = nulls + 1, width = 3 * it->of->contacts;
    const double cap = UNBOUNDED * it->unit - it->t;
    memset(g, 0, n * sizeof *g);
    memset(H, 0, (size_t)n * n * sizeof *H);
    g[n - 1] = -1 / it->mu + 1 / cap;
    H[n * n - 1] = 1 / (cap * cap);
    for (int i = 0; i < it->of->contacts; i++) {
        const double *f = it->of->force + 3 * i + 1, left = slack(it, i), u = room(it, i);
        double slope[SIZE], du[SIZE];       /* gradients of the slack and of the room */
        for (int k = 0; k < nulls; k++) {
            const double *change = it->null + k * width + 3 * i;
            du[k] = coefficient(it, i) * change[0];
            slope[k] = 2 * (u * du[k] - f[0] * change[1] - f[1] * change[2]);
        }
        du[nulls] = -1, slope[nulls] = -2 * u;
        for (int k = 0; k < n; k++) {
            g[k] -= slope[k] / left;
            for (int j = 0; j < n; j++) H[k * n + j] += slope[k] / left * (slope[j] / left) - 2 * du[k] * du[j] / left;
        }
        for (int k = 0; k < nulls; k++)
            for (int j = 0; j < nulls; j++) {
                const double *a = it->null + k * width + 3 * i, *b = it->null + j * width + 3 * i;
                H[k * n + j] += 2 * (a[1] * b[1] + a[2] * b[2]) / left;
            }
    }
    for (int k = 0; k < nulls; k++) {
        const double *a = it->null + k * width, scale = 1 / (it->unit * it->unit);
        g[k] += zd_dot(width, a, it->of->force) * scale;
        for (int j = 0; j < nulls; j++) H[k * n + j] += zd_dot(width, a, it->null + j * width) * scale;
    }
}

static void move(barrier *it, const double *step, double by)
{
    const int width = 3 * it->of->contacts;
    for (int k = 0; k < it->of->nulls; k++)
        for (int i = 0; i < width; i++) it->of->force[i] += by * step[k] * it->null[k * width + i];
    it->t += by * step[it->of->nulls];
}

/* One step of Newton's method, shortened by its own length, so that it stays within the cones; 0: there is nothing to gain. */
static int improve(barrier *it)
{
    double g[SIZE], H[SIZE * SIZE], step[SIZE], slope = 0;
    const int n = it->of->nulls + 1;
    differentiate(it, g, H);
    if (zd_cholesky(n, H, H) < n) return 0;
    for (int k = 0; k < n; k++) step[k] = -g[k];
    zd_forward(n, H, step, step);
    zd_backward(n, H, step, step);
    for (int k = 0; k < n; k++) slope -= g[k] * step[k];
    const double length = sqrt(fmax(0, slope));
    if (!(slope > 1e-9)) return 0;
    move(it, step, length < 0.25 ? 1 : 1 / (1 + length));
    return 1;
}

void zd_distribution_add(zd_distribution *self, double N, int is_free, const double *f, double coefficient)
{
    const int at = 3 * self->contacts;
    if (self->contacts == ZD_MAX_DISTRIBUTED || self->components + is_free + (f ? 2 : 0) > ZD_MAX_FREE) return;
    self->force[at] = N;
    if (is_free) self->component[self->components++] = at;
    for (int i = 0; i < 2; i++) {
        self->force[at + 1 + i] = f ? f[i] : 0;
        if (f) self->component[self->components++] = at + 1 + i;
    }
    self->friction[self->contacts++] = f ? coefficient : 0;
}

/* null (nulls, 3 contacts) */
static void find_nulls(zd_distribution *self, double *K, double *null)
{
    const int n = self->components, width = 3 * self->contacts;
    double of_components[ZD_MAX_FREE * ZD_MAX_FREE];
    self->nulls = zd_equations_null_space(n, K, of_components);
    zd_clear(self->nulls * width, null);
    for (int k = 0; k < self->nulls; k++)
        for (int i = 0; i < n; i++) null[k * width + self->component[i]] = of_components[k * n + i];
}

void zd_distribution_find(zd_distribution *self, double *K)
{
    double null[ZD_MAX_FREE * 3 * ZD_MAX_DISTRIBUTED];
    find_nulls(self, K, null);
    barrier it = {.of = self, .null = null, .unit = zd_max_abs(3 * self->contacts, self->force), .t = INFINITY};
    if (!(it.unit > 0)) it.unit = 1e-300;
    for (int i = 0; i < self->contacts; i++)
        it.t = fmin(it.t, coefficient(&it, i) * self->force[3 * i] - zd_hypotenuse(self->force[3 * i + 1], self->force[3 * i + 2]));
    self->margin = it.t;
    it.t = fmin(it.t, 0) - it.unit;
    it.mu = it.unit;
    for (int i = 0; i < STEPS && it.mu > PRECISION * it.unit; i++)
        if (!improve(&it)) it.mu /= 8;
    if (self->nulls) self->margin = it.t;
    for (int i = 0; i < self->contacts; i++) self->weight[i] = it.mu * 2 * room(&it, i) / slack(&it, i);
}
