/* Whether all rows count, from how little they have changed since it was last looked at closely.
 *
 * The closer look orthogonalizes the rows: C0 = R Q. As long as |R^-1 (C - C0)| < 1, C = R (Q + R^-1 (C - C0)) has as many independent
 * rows; and with w_k the length of column k of R^-1, which is 1 / what is left of row k once all others are taken out of it,
 *
 *     |R^-1 (C - C0)|  <=  sum_k w_k |C_k - C0_k|.
 *
 * Below NEAR, shares are at most so much smaller than they were, and any two such C have rows that span spaces less than a right angle apart,
 * as 2 NEAR + NEAR^2 < 1. So the sum also tells that no bifurcation lies between them, see safeguards/crossing.c. C0 is kept in single
 * precision, whose rounding is nothing beside that. Where the structure is declared, there is a smaller bound, by bodies.
 */
#include "look.h"

#include <math.h>

#include "../linalg/small.h"
#include "../point/gram.h"
#include "../point/matrices.h"

static const double NEAR = 0.4;             /* of the sum: nothing needs to be looked at */
static const double FAR = 0.9;              /* of the sum: beyond, rows may have come to lie reversed */
static const double DOUBTFUL = ZD_DOUBTFUL * ZD_DOUBTFUL, ILL = ZD_ILL_CONDITIONED * ZD_ILL_CONDITIONED;
static const double AMPLE = 16 * ZD_ILL_CONDITIONED * ZD_ILL_CONDITIONED;   /* the share, squared, from which rows may change by NEAR */

zd_look *zd_look_take(zd_arena *arena, const zd_system *system, double *Q, double *G)
{
    size_t n = (size_t)system->nv, m = (size_t)zd_constraints(system);
    const size_t dense = system->structure ? 0 : n;     /* where structure is declared, products of rows take their place */
    zd_look self = {
        .C = zd_take(arena, (size_t)zd_size_of_C(system) * sizeof(float)),
        .weight = zd_take_doubles(arena, m),
        .close = {
            .n = (int)n,
            .m = (int)m,
            .Q = Q ? Q : zd_take_doubles(arena, m * dense),
            .G = G ? G : zd_take_doubles(arena, m * m),
            .square = zd_take_doubles(arena, m),
            .rows = zd_take_doubles(arena, 4 * dense),
            .weighted = zd_take_doubles(arena, dense > m ? dense : m),
        },
    };
    return zd_take_filled(arena, &self, sizeof self);
}

/* Squared lengths of what has changed of some rows in the columns of a body, times their weights squared, added up. */
ZD_INLINE double add_changes(const int n, int rows, const double *C, const float *C0, int width, const double *weight)
{
    double sum = 0;
    for (int k = 0; k < rows; k++, C += width, C0 += width) {
        double square = 0;
        for (int i = 0; i < n; i++) square += (C[i] - (double)C0[i]) * (C[i] - (double)C0[i]);
        sum += weight[k] * weight[k] * square;
    }
    return sum;
}

/* The same of all rows that touch a body, times their number. */
ZD_INLINE double change_of_body(const int n, const zd_look *self, const zd_point *point, int b)
{
    const zd_layout *layout = point->layout;
    double sum = 0;
    int count = 0;
    for (int i = layout->toucher_at[b]; i < layout->toucher_at[b + 1]; i++) {
        const int g = layout->toucher[i], at = layout->C_at[g] + layout->toucher_offset[i], row = layout->row_at[g];
        const int rows = layout->row_at[g + 1] - row;
        sum += add_changes(n, rows, point->terms.C + at, self->C + at, layout->width[g], self->weight + row);
        count += rows;
    }
    return count * sum;
}

/* With C = R Q where rows were kept, and those columns of C - C0 that are of body b: |R^-1 (C - C0)|^2 is at most the sum over all b of
 * (sum_k w_k |C_kb - C0_kb|)^2, and that without roots at most this. Infinite where nothing is known. */
static double bound_by_bodies(const zd_look *self, const zd_point *point)
{
    const zd_layout *layout = point->layout;
    double sum = 0;
    for (int b = 0; layout && self->is_known && b < layout->blocks; b++) {
        const int n = layout->velocity_at[b + 1] - layout->velocity_at[b];
        sum += n == 3 ? change_of_body(3, self, point, b) : change_of_body(n, self, point, b);
    }
    return layout && self->is_known ? sum : INFINITY;
}

/* The sum, or infinity where nothing is known. */
static double find_change(const zd_look *self, const zd_point *point)
{
    double sum = 0;
    for (int k = 0; k < self->close.m; k++) {
        double squares[4] = {0, 0, 0, 0};
        const zd_row_of_C row = zd_point_row(point, k);
        const double *c = row.x;
        const float *c0 = self->C + (c - point->terms.C);
        const int n = row.count;
        int i = 0;
        for (; i + 4 <= n; i += 4)
            for (int r = 0; r < 4; r++) squares[r] += (c[i + r] - (double)c0[i + r]) * (c[i + r] - (double)c0[i + r]);
        for (; i < n; i++) squares[0] += (c[i] - (double)c0[i]) * (c[i] - (double)c0[i]);
        sum += self->weight[k] * sqrt(squares[0] + squares[1] + squares[2] + squares[3]);
    }
    return self->is_known ? sum : INFINITY;
}

/* weight <- lengths of the columns of R^-1, from G, in place of which comes its inverse */
static void find_weights(zd_look *self)
{
    const int m = self->close.m;
    double *G = self->close.G, *g = self->close.weighted;
    for (int k = 0; k < m; k++) self->weight[k] = 0;
    for (int i = 0; i < m; i++) {
        double *x = G + i * m, inverse_square = x[i];
        for (int j = 0; j < i; j++) g[j] = x[j], x[j] = 0;
        for (int j = 0; j < i; j++) {
            for (int k = 0; k < j; k++) x[k] -= g[j] * G[j * m + k];
            x[j] -= g[j];
        }
        for (int k = 0; k < i; k++) self->weight[k] += inverse_square * x[k] * x[k];
        self->weight[i] += inverse_square;
    }
    for (int k = 0; k < m; k++) self->weight[k] = sqrt(self->weight[k]);
}

/* Keeps rows whose shares are known, if these are ample. */
static void keep(zd_look *self, const zd_point *point)
{
    const int m = self->close.m, stored = zd_size_of_C(point->system);
    const double *C = point->terms.C, *start_square = point->rank->start_square;
    const double *square = self->close.square;
    find_weights(self);
    self->is_known = 1;
    for (int k = 0; k < m; k++)
        self->is_known &= 1 > AMPLE * square[k] * self->weight[k] * self->weight[k] && square[k] > AMPLE * start_square[k];
    for (int i = 0; i < stored; i++) self->C[i] = (float)C[i];
}

/* The same from products, where the structure is declared: the pivots of C C^T are the squares of what is left of each row once those before
 * it are taken out. Rounding leaves them off by 2^-52 of the row's square times a small number. */
static zd_shares factor_products(zd_look *self, const zd_point *point)
{
    const int m = self->close.m;
    double *G = self->close.G, *square = self->close.square;
    zd_gram(point->layout, point->terms.C, NULL, G);
    for (int k = 0; k < m; k++) square[k] = G[k * (m + 1)];
    zd_shares shares = {ZD_SIZED(zd_cholesky, m, G, G), 1, INFINITY};
    for (int k = 0; k < shares.rows; k++) {
        double share = 1 / (G[k * (m + 1)] * square[k]);
        if (!(share > DOUBTFUL)) shares.rows = k;
        else shares.least = fmin(shares.least, share);
    }
    return shares;
}

int zd_look_is_doubtful(zd_look *self, zd_point *point)
{
    zd_rank *rank = point->rank;
    const double bound = bound_by_bodies(self, point);
    if (bound < NEAR * NEAR) return 0;
    const double change = fmin(sqrt(bound), find_change(self, point));
    if (change < NEAR) return 0;
    self->close.C = point->terms.C;
    const zd_shares shares = point->layout ? factor_products(self, point) : zd_orthogonalize(&self->close, DOUBTFUL);
    rank->was_turned |= !(change < FAR);
    self->is_known = 0;
    int is_short = 0, is_ill = shares.rows < self->close.m || !(shares.least > ILL);
    for (int k = 0; k < shares.rows; k++) {
        is_short |= !(self->close.square[k] > DOUBTFUL * rank->start_square[k]);
        is_ill |= !(self->close.square[k] > ILL * rank->start_square[k]);
    }
    rank->was_ill_conditioned |= is_ill;
    if (is_short || shares.rows < self->close.m) return 1;
    if (!is_ill) keep(self, point);
    return 0;
}
