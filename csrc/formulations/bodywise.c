/* Equations (8) with a matrix that bodies couple in,
 *
 *     (M + C^T W C) dx = r + C^T W s,        dlambda = W (C dx - s),        r = force - M x - C^T lambda,  s = rhs - C x
 *
 * again and again from x = 0, lambda = 0 (the method of multipliers: Hestenes, Multiplier and gradient methods, 1969). Each time leaves of s
 * a part that is the smaller the larger W is, and each time the equations are those without W, so that W costs no digits. The matrix is
 * definite where C leaves free nothing that has no mass, whether or not M is, and whether or not rows of C follow from others. Of multipliers
 * that are not determined these are the smallest, sum lambda_k^2 / W_k = min, as they are W times what is in the range of C: with 1 / W_k
 * proportional to C_k M^-1 C_k^T, those of least effect, see constraints/rank.c.
 */
#include "bodywise.h"

#include <math.h>
#include <string.h>

#include "../linalg/small.h"
#include "../point/mass.h"
#include "../point/matrices.h"

enum { MAX_ITERATIONS = 12 };
static const double WEIGHT = 0x1p22;            /* of a row in units of what its bodies have as mass in it */
static const double ROUNDING = 4 * 0x1p-52;     /* of the terms of the equations: nothing to be corrected */

static void *take(zd_arena *arena, const void *of)
{
    const zd_system *system = of;
    const size_t n = (size_t)system->nv, m = (size_t)zd_constraints(system);
    zd_bodywise self = {
        .weight = zd_take_doubles(arena, m),
        .inverse = zd_take_doubles(arena, (size_t)zd_size_of_M(system)),
        .unbalanced = zd_take_doubles(arena, n),
        .step = zd_take_doubles(arena, n),
        .rest = zd_take_doubles(arena, m),
        .lambda = zd_take_doubles(arena, m),
    };
    return zd_take_filled(arena, &self, sizeof self);
}

zd_bodywise *zd_bodywise_create(zd_store *store, const zd_point *point)
{
    zd_bodies *bodies = zd_bodies_create(store, point->system, point->layout, NULL);
    zd_bodywise *self = bodies ? zd_store_take(store, take, point->system) : NULL;
    if (!self) return NULL;
    self->layout = point->layout;
    self->bodies = bodies;
    return self;
}

/* ---- factors ---- */

/* C_k M^-1 C_k^T; or where M has no inverse, the squared length of the row over the largest mass. */
static double effect(const zd_bodywise *self, const zd_row_of_C *row, int has_inverse, double mass)
{
    const zd_layout *layout = self->layout;
    double sum = 0;
    if (!has_inverse) return zd_dot(row->count, row->x, row->x) / mass;
    for (int j = 0; j < row->count;) {
        const int b = layout->block_of[row->column[j]], n = layout->velocity_at[b + 1] - layout->velocity_at[b];
        const double *L = self->inverse + layout->M_at[b], *c = row->x + j;
        for (int i = 0; layout->is_diagonal[b] && i < n; i++) sum += c[i] * L[i] * c[i];
        if (!layout->is_diagonal[b]) zd_forward(n, L, c, self->step);
        if (!layout->is_diagonal[b]) sum += zd_metric_dot(n, L, self->step, self->step);
        j += n;
    }
    return sum;
}

static void set_weights(zd_bodywise *self, const zd_point *point)
{
    const int n = point->system->nv, has_inverse = zd_mass_factor(point, self->inverse) == n;
    double mass = 0;
    for (int i = 0; i < n; i++) mass = fmax(mass, zd_entry_of_M(point, i, i));
    for (int k = 0; k < zd_constraints(point->system); k++) {
        const zd_row_of_C row = zd_point_row(point, k);
        const double square = effect(self, &row, has_inverse, mass > 0 ? mass : 1);
        self->weight[k] = square > 0 ? WEIGHT / square : 0;
    }
}

int zd_bodywise_factor(zd_bodywise *self, zd_point *point)
{
    self->point = point;
    self->C = point->terms.C;
    set_weights(self, point);
    zd_blocks_clear(self->bodies->blocks);
    zd_bodies_add_mass(self->bodies, point->terms.M);
    zd_bodies_add_rows(self->bodies, self->C, self->weight);
    const zd_pivots pivots = zd_blocks_factor(self->bodies->blocks, NULL, 0);
    if (pivots.failed < 0) return ZD_DONE;
    point->failed_index = zd_bodies_velocity(self->bodies, pivots.failed);
    return ZD_NOT_DEFINITE;
}

/* ---- solution ---- */

/* unbalanced <- force - M x - C^T lambda + C^T W rest, rest <- rhs - C x. Returns how much of them is left, in units of what their terms are;
 * of the former without W. */
static double find_rest(zd_bodywise *self, const double *force, const double *rhs, const double *x)
{
    const int n = self->point->system->nv, m = zd_constraints(self->point->system);
    double left = 0, *b = self->unbalanced, *size = self->step;
    zd_times_M(self->point, self->point->terms.M, x, b);
    for (int i = 0; i < n; i++) {
        const double given = force ? force[i] : 0;
        size[i] = fabs(given) + fabs(b[i]);
        b[i] = given - b[i];
    }
    for (int k = 0; k < m; k++) {
        const zd_row_of_C row = zd_packed_row(self->layout, self->C, k);
        double sum = rhs[k], terms = fabs(rhs[k]);
        for (int j = 0; j < row.count; j++) {
            const double term = row.x[j] * x[row.column[j]], reaction = row.x[j] * self->lambda[k];
            sum -= term, terms += fabs(term);
            b[row.column[j]] -= reaction, size[row.column[j]] += fabs(reaction);
        }
        self->rest[k] = sum;
        if (fabs(sum) > left * terms) left = fabs(sum) / terms;
    }
    double largest = 0, worst = 0;
    for (int i = 0; i < n; i++) largest = fmax(largest, size[i]), worst = fmax(worst, fabs(b[i]));
    for (int k = 0; k < m; k++) {
        const zd_row_of_C row = zd_packed_row(self->layout, self->C, k);
        for (int j = 0; j < row.count; j++) b[row.column[j]] += self->weight[k] * self->rest[k] * row.x[j];
    }
    return worst > left * largest ? worst / largest : left;
}

void zd_bodywise_solve(zd_bodywise *self, const double *force, const double *rhs, double *x, double *lambda)
{
    const int n = self->point->system->nv, m = zd_constraints(self->point->system);
    memset(x, 0, (size_t)n * sizeof *x);
    memset(self->lambda, 0, (size_t)m * sizeof *x);
    double before = INFINITY;
    for (int i = 0; i < MAX_ITERATIONS; i++) {
        const double left = find_rest(self, force, rhs, x);
        if (!(left > ROUNDING) || (i > 1 && !(left < 0.25 * before))) break;
        before = left;
        zd_bodies_solve(self->bodies, self->unbalanced, self->step);
        for (int k = 0; k < m; k++) {
            const zd_row_of_C row = zd_packed_row(self->layout, self->C, k);
            self->lambda[k] += self->weight[k] * (zd_row_times(&row, self->step) - self->rest[k]);      /* (8) */
        }
        for (int j = 0; j < n; j++) x[j] += self->step[j];
    }
    if (lambda) memcpy(lambda, self->lambda, (size_t)m * sizeof *lambda);
}
