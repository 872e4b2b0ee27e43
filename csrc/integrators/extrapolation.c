/* The explicit midpoint rule in 2, 4, 6 and 8 parts of a step, extrapolated to parts of no length: W. B. Gragg, SIAM J. Numer.
 * Anal. 2 (1965) 384; R. Bulirsch, J. Stoer, Numer. Math. 8 (1966) 1.
 *
 *     z_1 = y0 + h/n f(t0, y0),    z_(j+1) = z_(j-1) + 2 h/n f(t0 + j h/n, z_j),    y1 = sum_n weight_n z_n
 *
 * The errors of the four z_n have powers of 1/n^2 alone, and the weights remove the first three: the order is eight. What is added
 * up is z_n - y0, as the weights would multiply the rounding of y0.
 */

#include "../linalg/small.h"
#include "integrator.h"

enum { SEQUENCES = 4 };
static const int parts[SEQUENCES] = {2, 4, 6, 8};
static const double weight[SEQUENCES] = {-1.0 / 360, 16.0 / 45, -729.0 / 280, 1024.0 / 315};

typedef struct extrapolation {
    int size;
    double *f0, *f;         /* (size,) */
    double *z;              /* (size,) */
    double *change[2];      /* (size,): z_j - y0 of the even j, and of the odd */
    double *sum;            /* (size,): of the weighted z_n - y0 */
} extrapolation;

static void *create(zd_arena *arena, const void *table, zd_motion *motion, double *y, int size, const void *given)
{
    (void)table, (void)motion, (void)y, (void)given;
    size_t n = size;
    extrapolation self = {
        .size = size,
        .f0 = zd_arena_doubles(arena, n),
        .f = zd_arena_doubles(arena, n),
        .z = zd_arena_doubles(arena, n),
        .change = {zd_arena_doubles(arena, n), zd_arena_doubles(arena, n)},
        .sum = zd_arena_doubles(arena, n),
    };
    return zd_arena_copy(arena, &self, sizeof self);
}

/* change[0] <- z_n - y0 */
static int make_parts(extrapolation *self, const zd_rate *rate, double t, double h, const double *y, int n)
{
    int size = self->size;
    for (int i = 0; i < size; i++) {
        self->change[0][i] = 0;
        self->change[1][i] = h / n * self->f0[i];
    }
    for (int j = 1; j < n; j++) {
        for (int i = 0; i < size; i++) self->z[i] = y[i] + self->change[j % 2][i];
        int status = rate->evaluate(rate->context, t + j * h / n, self->z, self->f);
        if (status) return status;
        zd_add_scaled(size, self->change[(j + 1) % 2], 2 * h / n, self->f);
    }
    return ZD_DONE;
}

static int step(void *memory, const zd_rate *rate, double t, double h, double *y, zd_statistics *statistics)
{
    (void)statistics;
    extrapolation *self = memory;
    int status = rate->evaluate(rate->context, t, y, self->f0);
    zd_clear(self->size, self->sum);
    for (int k = 0; !status && k < SEQUENCES; k++) {
        status = make_parts(self, rate, t, h, y, parts[k]);
        zd_add_scaled(self->size, self->sum, weight[k], self->change[0]);
    }
    if (status) return status;
    for (int i = 0; i < self->size; i++) y[i] += self->sum[i];
    return ZD_DONE;
}

const zd_integrator zd_extrapolation = {
    .card = {
        .name = "extrapolation",
        .summary = "The explicit midpoint rule in 2, 4, 6 and 8 parts, extrapolated, to order eight.",
        .equations = "Gragg, 1965; Bulirsch and Stoer, 1966",
        .order = 8, .stability = 3.39,
        .description = "A step is made in 2, 4, 6 and 8 parts by the explicit midpoint rule, and the four results are extrapolated to parts "
                       "of length zero. Its coefficients have nothing in common with those of Runge-Kutta methods, so that the two verify "
                       "each other; it takes more evaluations than dop853.",
        .reference = "W. B. Gragg, SIAM Journal on Numerical Analysis 2 (1965) 384-403; R. Bulirsch, J. Stoer, Numerische "
                     "Mathematik 8 (1966) 1-13",
    },
    .decay = 4.31,
    .create = create,
    .step = step,
};
