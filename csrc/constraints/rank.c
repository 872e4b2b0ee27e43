/* Numerical rank of C, and the multipliers of redundant constraints.
 *
 * Rows are orthogonalized, the row with the largest residual next, in two metrics: the plain one, which is insensitive to masses of
 * different magnitude, and that of M^-1, which is insensitive to units. The larger of the two ranks is taken. With C_r the selected
 * rows, and the others C_d = T C_r, the motion is that of the constraints C_r alone, and
 *
 *     C^T lambda = C_r^T lambda_r
 *
 * leaves the multipliers undetermined. The smallest are taken, sum s_k^2 lambda_k^2 = min, with s_k^2 = C_k M^-1 C_k^T: this minimizes
 * the accelerations that each constraint's own reaction would cause, whatever the units of constraints and coordinates. With W = diag(1
 * / s_k^2) and B = [I; T],
 *
 *     lambda = W B (B^T W B)^-1 lambda_r.
 *
 * If M is singular, or nearly so, s_k is the plain norm of the row.
 */
#include "rank.h"

#include <math.h>
#include <string.h>

#include "../linalg/small.h"
#include "../point/point.h"

static zd_selection *create_selection(zd_arena *arena, const zd_system *system)
{
    size_t n = system->nv, m = zd_constraints(system);
    zd_selection self = {
        .n = (int)n,
        .m = (int)m,
        .mh = system->mh,
        .redundant = zd_arena_ints(arena, m),
        .row = zd_arena_ints(arena, m),
        .row_at = zd_arena_ints(arena, m),
        .C = zd_arena_doubles(arena, m * n),
        .Q = zd_arena_doubles(arena, m * n),
        .G = zd_arena_doubles(arena, m * m),
        .square = zd_arena_doubles(arena, m),
        .strength = zd_arena_doubles(arena, m),
        .square_left = zd_arena_doubles(arena, m),
        .weight = zd_arena_doubles(arena, m),
        .K = zd_arena_doubles(arena, m * m),
        .L = zd_arena_doubles(arena, n * n),
        .rhs = zd_arena_doubles(arena, m),
        .lambda = zd_arena_doubles(arena, m),
        .lambda_r = zd_arena_doubles(arena, m),
        .R = zd_arena_doubles(arena, m * m),
    };
    return zd_arena_copy(arena, &self, sizeof self);
}

zd_rank *zd_rank_create(zd_arena *arena, const zd_system *system, int is_large)
{
    size_t m = zd_constraints(system);
    zd_rank self = {
        .n = system->nv,
        .m = (int)m,
        .mh = system->mh,
        .max_rank = (int)m,
        .max_rank_holonomic = system->mh,
        .is_large = is_large,
        .start_square = zd_arena_doubles(arena, m),
        .terms_square = zd_arena_doubles(arena, m),
        .selection = is_large ? NULL : create_selection(arena, system),
    };
    zd_rank *rank = zd_arena_copy(arena, &self, sizeof self);
    if (rank && rank->selection) rank->selection->rank = rank;
    return rank;
}

/* ---- selection of independent constraints ---- */

/* Q <- C, or C L^-T D^-1/2: then plain products are those of M^-1. */
static void set_rows(const zd_point *point, const double *L)
{
    zd_selection *self = point->rank->selection;
    int n = self->n;
    for (int k = 0; k < self->m; k++) {
        double *q = self->Q + k * n;
        zd_row_of_C row = zd_point_row(point, k);
        zd_row_expand(&row, n, q);
        if (L) zd_forward(n, L, q, q);
        for (int i = 0; L && i < n; i++) q[i] *= sqrt(L[i * n + i]);
        self->square[k] = self->square_left[k] = zd_dot(n, q, q);
        double length = zd_dot(row.count, row.x, row.x);
        self->strength[k] = fmin(1, length / self->rank->terms_square[k]);
        if (!(length > self->tolerance * self->rank->start_square[k])) self->square_left[k] = 0;
    }
}

/* Index of the row in [begin, end) with the largest relative residual, weighted by its strength, or -1. A later row is preferred to an
 * earlier one only if its value is four times as large, so that rounding does not change the selection from point to point. */
static int choose_row(const zd_selection *self, int begin, int end)
{
    int best = -1;
    double most = 0;
    for (int k = begin; k < end; k++) {
        if (!(self->square_left[k] > self->tolerance * self->square[k])) continue;
        const double share = self->strength[k] * self->square_left[k] / self->square[k];
        if (best >= 0 && !(share > most)) continue;
        best = k;
        most = 4 * share;
    }
    return best;
}

static void project_out(zd_selection *self, int chosen, int rank)
{
    int n = self->n;
    double *q = self->Q + chosen * n, length = sqrt(zd_dot(n, q, q));
    for (int i = 0; i < n; i++) q[i] /= length;
    self->G[chosen * self->m + rank] = length;
    self->rank->was_ill_conditioned |= !(length * length > ZD_ILL_CONDITIONED * ZD_ILL_CONDITIONED * self->square[chosen]);
    self->square_left[chosen] = -1;
    for (int k = 0; k < self->m; k++) {
        double *other = self->Q + k * n;
        if (self->square_left[k] < 0) continue;
        double along = self->G[k * self->m + rank] = zd_dot(n, q, other);
        zd_add_scaled(n, other, -along, q);
        if (self->square_left[k] > 0) self->square_left[k] = zd_dot(n, other, other);
    }
}

static int orthogonalize(const zd_point *point, const double *L)
{
    zd_selection *self = point->rank->selection;
    int rank = 0, chosen;
    set_rows(point, L);
    while (rank < self->rank->max_rank && rank < self->rank->max_rank_holonomic && (chosen = choose_row(self, 0, self->mh)) >= 0) {
        project_out(self, chosen, rank);
        self->row[rank++] = chosen;
    }
    while (rank < self->rank->max_rank && (chosen = choose_row(self, self->mh, self->m)) >= 0) {
        project_out(self, chosen, rank);
        self->row[rank++] = chosen;
    }
    for (int k = 0, next = rank; k < self->m; k++)
        if (self->square_left[k] >= 0) self->row[next++] = k;
    return rank;
}

static void set_weights(zd_selection *self)
{
    for (int k = 0; k < self->m; k++) self->weight[k] = self->square_left[k] != 0 && self->square[k] > 0 ? 1 / self->square[k] : 0;
}

/* True if M^-1 can serve as a metric: with a smaller pivot, rounding in that metric would be as large as the tolerance. */
static int has_metric(const zd_point *point)
{
    zd_selection *self = point->rank->selection;
    int n = self->n;
    if (zd_cholesky(n, zd_dense_M(point, self->L), self->L) < n) return 0;
    for (int i = 0; i < n; i++)
        if (!(1 > ZD_MIN_PIVOT * zd_entry_of_M(point, i, i) * self->L[i * n + i])) return 0;
    return 1;
}

/* Maximum of the ranks in the two metrics. G holds the products of all rows with the selected ones. */
static int rank_of(const zd_point *point)
{
    zd_selection *self = point->rank->selection;
    int rank = orthogonalize(point, NULL);
    if (rank == self->m) return rank;
    set_rows(point, NULL);
    set_weights(self);
    if (!has_metric(point)) return orthogonalize(point, NULL);
    set_rows(point, self->L);
    set_weights(self);
    int other = orthogonalize(point, self->L);
    return other < rank ? orthogonalize(point, NULL) : other;
}

/* Orthogonalizes the rows that are selected already. */
static void orthogonalize_chosen(const zd_point *point)
{
    zd_selection *self = point->rank->selection;
    set_rows(point, NULL);
    for (int a = 0; a < self->independent; a++) project_out(self, self->row[a], a);
}

/* Sets T in the dependent rows of G: T G_r = G_d, where G_r is triangular in the order of selection. */
static void express_others(zd_selection *self, int rank)
{
    int m = self->m;
    for (int d = rank; d < m; d++) {
        double *T = self->G + self->row[d] * m;
        for (int a = rank - 1; a >= 0; a--) {
            for (int b = a + 1; b < rank; b++) T[a] -= T[b] * self->G[self->row[b] * m + a];
            T[a] /= self->G[self->row[a] * m + a];
        }
    }
}

/* B^T W B, factored */
static void set_shares(zd_selection *self, int rank)
{
    for (int a = 0; a < rank; a++)
        for (int b = 0; b < rank; b++) {
            double sum = a == b ? self->weight[self->row[a]] : 0;
            for (int d = rank; d < self->m; d++) {
                const double *T = self->G + self->row[d] * self->m;
                sum += T[a] * self->weight[self->row[d]] * T[b];
            }
            self->K[a * rank + b] = sum;
        }
    zd_cholesky(rank, self->K, self->K);
}

void zd_rank_use_all(zd_point *point)
{
    point->rows = point->rank->is_large ? point->rank->max_rank : point->rank->m;
    point->holonomic = point->rank->is_large ? point->rank->max_rank_holonomic : point->rank->mh;
    point->C = point->terms.C;
    point->rank->lost = 0;
}

/* Sets T of a selection that was kept. Flags of the step are restored, so that later steps are independent of this call. */
static void express_selection(const zd_point *point)
{
    zd_selection *self = point->rank->selection;
    const int was_ill_conditioned = self->rank->was_ill_conditioned;
    self->tolerance = ZD_RANK_TOLERANCE * ZD_RANK_TOLERANCE;
    orthogonalize_chosen(point);
    express_others(self, self->independent);
    self->rank->was_ill_conditioned = was_ill_conditioned;
}

/* Sets T and K of a selection that was kept. */
static void express(const zd_point *point)
{
    zd_selection *self = point->rank->selection;
    self->tolerance = ZD_RANK_TOLERANCE * ZD_RANK_TOLERANCE;
    set_rows(point, has_metric(point) ? self->L : NULL);
    set_weights(self);
    express_selection(point);
    set_shares(self, self->independent);
    self->is_expressed = 1;
}

void zd_rank_express_others(const zd_point *point)
{
    if (!point->rank->selection->is_expressed) express_selection(point);
}

static void use_chosen(zd_point *point, int rank)
{
    zd_selection *self = point->rank->selection;
    int n = self->n;
    for (int a = 0; a < rank; a++) {
        self->row_at[a] = self->row[a];
        zd_row_of_C row = zd_point_row(point, self->row[a]);
        zd_row_expand(&row, n, self->C + a * n);
    }
    self->independent = point->rows = rank;
    self->rank->lost = 0;
    point->C = self->C;
    point->holonomic = 0;
    while (point->holonomic < rank && self->row[point->holonomic] < self->mh) point->holonomic++;
}

void zd_rank_choose(zd_point *point, double tolerance)
{
    zd_selection *self = point->rank->selection;
    self->tolerance = tolerance;
    int rank = rank_of(point);
    if (rank == self->m) {
        zd_rank_use_all(point);
        return;
    }
    express_others(self, rank);
    set_shares(self, rank);
    self->is_expressed = 1;
    use_chosen(point, rank);
}

void zd_rank_use(zd_point *point, const int *row, int independent)
{
    zd_selection *self = point->rank->selection;
    memcpy(self->row, row, self->m * sizeof *row);
    self->is_expressed = 0;
    use_chosen(point, independent);
}

/* ---- characteristic scales ---- */

void zd_rank_scale(const zd_point *point, int row, double *x)
{
    for (int i = 0; i < point->rank->n; i++) x[i] *= point->unit[i] * point->inverse_size[row];
}

void zd_rank_set_basis(const zd_point *point)
{
    zd_selection *self = point->rank->selection;
    int n = self->n, m = self->m;
    zd_clear(m * m, self->R);
    for (int a = 0; a < self->independent; a++) {
        double *q = self->Q + a * n, *r = self->R + a * m;
        zd_row_of_C row = zd_point_row(point, self->row[a]);
        zd_row_expand(&row, n, q);
        zd_rank_scale(point, self->row[a], q);
        for (int again = 0; again < 2; again++)
            for (int b = 0; b < a; b++) {
                double along = zd_dot(n, self->Q + b * n, q);
                r[b] += along;
                zd_add_scaled(n, q, -along, self->Q + b * n);
            }
        r[a] = sqrt(zd_dot(n, q, q));
        for (int i = 0; i < n; i++) q[i] /= r[a];
    }
}

/* ---- multipliers of all constraints ---- */

void zd_rank_share_out(const zd_point *point, double *lambda)
{
    zd_selection *self = point->rank->selection;
    const int rank = self->independent;
    if (!self->is_expressed) express(point);
    double *y = self->lambda;
    zd_forward(rank, self->K, y, y);
    zd_backward(rank, self->K, y, y);
    for (int a = 0; a < rank; a++) lambda[self->row[a]] = self->weight[self->row[a]] * y[a];
    for (int d = rank; d < self->m; d++)
        lambda[self->row[d]] = self->weight[self->row[d]] * zd_dot(rank, self->G + self->row[d] * self->m, y);
}
