/* Rank monitor: independence of the constraints from the change of C since the last full check.
 *
 * The full check orthogonalizes the rows: C0 = R Q. As long as |R^-1 (C - C0)| < 1, C = R (Q + R^-1 (C - C0)) has as many independent
 * rows; and with w_k the norm of column k of R^-1, which is 1 / residual norm of row k after all others are projected out,
 *
 *     |R^-1 (C - C0)|  <=  sum_k w_k |C_k - C0_k|.
 *
 * Below NEAR, relative residuals are bounded below, and any two such C have row spaces less than a right angle apart, as 2 NEAR + NEAR^2
 * < 1. So the sum also shows that no bifurcation lies between them, see safeguards/crossing.c. C0 is stored in single precision, whose
 * rounding is negligible here. For a declared structure there is a smaller bound, by bodies.
 *
 * If some constraints are redundant, C is the selection among them: as long as it has changed little, it has the same rank, and the
 * selection remains valid. Beyond, it is made anew, see rows.c.
 */
#include "rank_monitor.h"

#include <math.h>
#include <string.h>

#include "../linalg/small.h"
#include "../point/point.h"

static const double NEAR = 0.4;             /* change (the sum above): smaller changes need no full check */
static const double FAR = 0.9;              /* change: beyond, the row space may have reversed */
static const double DOUBTFUL = ZD_DOUBTFUL * ZD_DOUBTFUL, ILL = ZD_ILL_CONDITIONED * ZD_ILL_CONDITIONED;
static const double AMPLE_RESIDUAL = 16 * ZD_ILL_CONDITIONED * ZD_ILL_CONDITIONED; /* squared, relative: rows may change by NEAR */

zd_rank_monitor *zd_rank_monitor_create(zd_arena *arena, const zd_system *system, int selects, double *Q, double *G)
{
    size_t n = system->nv, m = zd_constraints(system);
    const int by_products = system->structure && !selects;      /* for a declared structure; rows of a selection are dense */
    const size_t dense = by_products ? 0 : n;
    zd_rank_monitor self = {
        .m = (int)m,
        .row = selects ? zd_arena_ints(arena, m) : NULL,
        .C = zd_arena_bytes(arena, zd_size_of_C(system) * sizeof(float)),
        .weight = zd_arena_doubles(arena, m),
        .share = system->structure ? zd_arena_doubles(arena, zd_size_of_C(system)) : NULL,
        .close = {
            .n = (int)n,
            .m = selects ? 0 : (int)m,
            .Q = Q ? Q : zd_arena_doubles(arena, m * dense),
            .G = G ? G : zd_arena_doubles(arena, m * (dense ? m : 0)),
            .square = zd_arena_doubles(arena, m),
            .rows = zd_arena_doubles(arena, 4 * dense),
            .weighted = zd_arena_doubles(arena, dense > m ? dense : m),
        },
        .identity = by_products ? zd_arena_doubles(arena, zd_size_of_M(system)) : NULL,
    };
    return zd_arena_copy(arena, &self, sizeof self);
}

static int row_of(const zd_rank_monitor *self, int k) { return self->row ? self->row[k] : k; }

/* Bound of |R^-1 (C - C0)|^2 by bodies: with C_b the columns of body b, at most the sum over b of (sum_k w_k |C_kb - C0_kb|)^2 over the
 * rows that touch b; and that, without square roots, at most their number times the sum of squares. So each entry has a weight of its
 * own. Infinite if no rows are stored. */
static double bound_by_bodies(const zd_rank_monitor *self, const zd_point *point)
{
    const double *C = point->terms.C;
    const int stored = self->is_known ? point->layout->C_at[point->layout->groups] : 0;
    double sums[4] = {0, 0, 0, 0};
    int i = 0;
    for (; i + 4 <= stored; i += 4)
        for (int r = 0; r < 4; r++)
            sums[r] += self->share[i + r] * ((C[i + r] - (double)self->C[i + r]) * (C[i + r] - (double)self->C[i + r]));
    for (; i < stored; i++) sums[0] += self->share[i] * ((C[i] - (double)self->C[i]) * (C[i] - (double)self->C[i]));
    return self->is_known ? sums[0] + sums[1] + sums[2] + sums[3] : INFINITY;
}

/* Weights of the entries of body b in the rows that touch it. */
static void find_shares(zd_rank_monitor *self, const zd_layout *layout, int b)
{
    const int n = layout->velocity_at[b + 1] - layout->velocity_at[b];
    int rows = 0;
    for (int i = layout->toucher_at[b]; i < layout->toucher_at[b + 1]; i++)
        rows += layout->row_at[layout->toucher[i] + 1] - layout->row_at[layout->toucher[i]];
    for (int i = layout->toucher_at[b]; i < layout->toucher_at[b + 1]; i++) {
        const int g = layout->toucher[i];
        double *share = self->share + layout->C_at[g] + layout->toucher_offset[i];
        for (int k = layout->row_at[g]; k < layout->row_at[g + 1]; k++, share += layout->width[g])
            for (int j = 0; j < n; j++) share[j] = rows * self->weight[k] * self->weight[k];
    }
}

/* Change of C (the sum above); infinite if no rows are stored. */
static double find_change(const zd_rank_monitor *self, const zd_point *point)
{
    double sum = 0;
    for (int k = 0; k < self->m; k++) {
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

/* weight <- norms of the columns of R^-1, from G, which is overwritten with its inverse. */
static void find_weights(zd_rank_monitor *self)
{
    const int m = self->close.m;
    double *G = self->close.G, *g = self->close.weighted;
    zd_clear(self->m, self->weight);
    for (int i = 0; i < m; i++) {
        double *x = G + i * m, inverse_square = x[i];
        for (int j = 0; j < i; j++) g[j] = x[j], x[j] = 0;
        for (int j = 0; j < i; j++) {
            for (int k = 0; k < j; k++) x[k] -= g[j] * G[j * m + k];
            x[j] -= g[j];
        }
        for (int k = 0; k < i; k++) self->weight[row_of(self, k)] += inverse_square * x[k] * x[k];
        self->weight[row_of(self, i)] += inverse_square;
    }
    for (int k = 0; k < self->m; k++) self->weight[k] = sqrt(self->weight[k]);
}

/* weight by blocks: square roots of the diagonal of (C C^T)^-1. */
static void find_weights_by_blocks(zd_rank_monitor *self, const zd_layout *layout)
{
    const zd_blocks *blocks = self->weighted->blocks;
    zd_blocks_invert(blocks, self->inverse);
    for (int g = 0; g < layout->groups; g++) {
        const int first = layout->row_at[g], rows = layout->row_at[g + 1] - first;
        const double *Z = self->inverse + blocks->pivot_at[blocks->place[g]];
        for (int i = 0; i < rows; i++) self->weight[first + i] = sqrt(Z[i * (rows + 1)]);
    }
}

/* Stores the rows of a full check, if their relative residuals are large enough. */
static void store(zd_rank_monitor *self, const zd_point *point)
{
    const int m = self->close.m, stored = zd_size_of_C(point->system);
    const double *C = point->terms.C, *start_square = point->rank->start_square;
    const double *square = self->close.square;
    if (point->layout && !self->row) find_weights_by_blocks(self, point->layout);
    else find_weights(self);
    self->is_known = 1;
    for (int k = 0; k < m; k++) {
        const double weight = self->weight[row_of(self, k)];
        self->is_known &= 1 > AMPLE_RESIDUAL * square[k] * weight * weight && square[k] > AMPLE_RESIDUAL * start_square[row_of(self, k)];
    }
    for (int i = 0; i < stored; i++) self->C[i] = (float)C[i];
    for (int b = 0; point->layout && b < point->layout->blocks; b++) find_shares(self, point->layout, b);
}

static int need_blocks(zd_rank_monitor *self, const zd_point *point)
{
    zd_store *store = point->rank->store;
    if (self->inverse) return 1;
    zd_set_identity(point->system, self->identity);
    if (!self->weighted) self->weighted = zd_weighted_create(store, point->layout);
    if (self->weighted) self->inverse = zd_store_bytes(store, self->weighted->blocks->size * sizeof(double));
    return self->inverse != NULL;
}

/* Full check by products, for a declared structure: the pivots of C C^T are the squared residual norms of the rows after those
 * eliminated before are projected out, to 2^-52 of the squared row times a small number. A body that is split enlarges the rows, which
 * makes relative residuals smaller. Without memory, all rows are flagged. */
static zd_shares factor_products(zd_rank_monitor *self, const zd_point *point)
{
    if (!need_blocks(self, point)) return (zd_shares){0, 1, 0};
    for (int k = 0; k < self->close.m; k++) {
        const zd_row_of_C row = zd_point_row(point, k);
        self->close.square[k] = zd_dot(row.count, row.x, row.x);
    }
    const zd_pivots pivots = zd_weighted_factor(self->weighted, point->terms.C, self->identity, NULL);
    const double least = pivots.failed < 0 ? pivots.pivot / pivots.diagonal : 0;
    return (zd_shares){least > DOUBTFUL ? self->close.m : 0, 1, least};
}

int zd_rank_monitor_is_doubtful(zd_rank_monitor *self, zd_point *point)
{
    zd_rank *rank = point->rank;
    const double bound = point->layout ? bound_by_bodies(self, point) : INFINITY;
    if (bound < NEAR * NEAR) return 0;
    const double change = fmin(sqrt(bound), find_change(self, point));
    if (change < NEAR) return 0;
    const zd_shares shares = point->layout ? factor_products(self, point) : zd_orthogonalize(&self->close, point->terms.C, DOUBTFUL);
    rank->was_turned |= !(change < FAR);
    self->is_known = 0;
    int is_short = 0, is_ill = shares.rows < self->close.m || !(shares.least > ILL);
    for (int k = 0; k < shares.rows; k++) {
        is_short |= !(self->close.square[k] > DOUBTFUL * rank->start_square[k]);
        is_ill |= !(self->close.square[k] > ILL * rank->start_square[k]);
    }
    rank->was_ill_conditioned |= is_ill;
    if (is_short || shares.rows < self->close.m) return 1;
    if (!is_ill) store(self, point);
    return 0;
}

void zd_rank_monitor_keep_selection(zd_rank_monitor *self, zd_point *point)
{
    const zd_selection *selection = point->rank->selection;
    self->is_known = 0;
    self->close.m = selection->independent;
    memcpy(self->row, selection->row, self->m * sizeof *self->row);
    if (zd_orthogonalize(&self->close, point->C, DOUBTFUL).rows == self->close.m) store(self, point);
}

int zd_rank_monitor_is_unchanged(const zd_rank_monitor *self, const zd_point *point)
{
    const double bound = point->layout ? bound_by_bodies(self, point) : INFINITY;
    return bound < NEAR * NEAR || fmin(sqrt(bound), find_change(self, point)) < NEAR;
}
