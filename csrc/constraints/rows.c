#include "rank.h"

#include "../linalg/small.h"
#include "../point/point.h"
#include "limits.h"
#include "rank_monitor.h"

static const double SQUARED = ZD_RANK_TOLERANCE * ZD_RANK_TOLERANCE, DOUBTFUL = ZD_DOUBTFUL * ZD_DOUBTFUL;
static const double ILL = ZD_ILL_CONDITIONED * ZD_ILL_CONDITIONED;

/* Keeps a selection of the maximum rank for later points if it is well conditioned, in the metric of M^-1 as well (`is_ill`). */
static void keep_selection(zd_point *point, int is_ill)
{
    zd_rank *self = point->rank;
    const int is_complete = self->is_started && point->rows == self->max_rank && self->max_rank < self->m && !self->lost && !is_ill;
    if (self->is_auxiliary || !self->kept) return;
    self->kept->is_known = 0;
    if (is_complete) zd_rank_monitor_keep_selection(self->kept, point);
}

static int reduce(zd_point *point)
{
    static const double region = ZD_LIMITS_REGION * ZD_LIMITS_REGION;
    zd_rank *self = point->rank;
    self->was_doubtful = self->was_turned = 1;
    int status = zd_point_need(point, ZD_M);
    if (status) return status;
    if (!zd_is_finite(zd_size_of_C(point->system), point->terms.C)) return ZD_NOT_FINITE;
    const int by_limits = self->is_started && self->allows_deficiency, was_ill_conditioned = self->was_ill_conditioned;
    self->was_ill_conditioned = 0;
    zd_rank_choose(point, by_limits ? region : SQUARED);
    if (by_limits && point->rows < self->max_rank) {
        status = zd_limits_find(point);
        if (!status && !self->lost) zd_rank_choose(point, SQUARED);
    }
    int is_deficient = self->lost || point->rows < self->max_rank;
    self->was_deficient |= is_deficient;
    if (!status) keep_selection(point, self->was_ill_conditioned);
    self->was_ill_conditioned |= was_ill_conditioned;
    if (is_deficient && !self->allows_deficiency) return ZD_BIFURCATION;
    if (!status) point->known |= ZD_RANKED;
    return status;
}

/* True if, in the plain metric, the rows (at most two) may be parallel or zero. */
ZD_INLINE int are_doubtful(const int n, const int m, zd_rank *self, const double *C)
{
    double square[ZD_FEW_CONSTRAINTS];
    for (int k = 0; k < m; k++) {
        square[k] = zd_dot(n, C + k * n, C + k * n);
        if (!(square[k] > DOUBTFUL * self->start_square[k])) return self->was_ill_conditioned = 1;
        self->was_ill_conditioned |= !(square[k] > ILL * self->start_square[k]);
    }
    if (m < 2) return 0;
    double along = zd_dot(n, C, C + n), both = square[0] * square[1];
    self->was_ill_conditioned |= !((1 - ILL) * both > along * along);
    return !((1 - DOUBTFUL) * both > along * along);
}

/* Specialized for two rows, the most common number. */
ZD_INLINE int are_few_doubtful(const int n, zd_rank *self, const double *C)
{
    return self->m == 2 ? are_doubtful(n, 2, self, C) : are_doubtful(n, self->m, self, C);
}

int zd_rows_are_long(const zd_point *point)
{
    const zd_rank *self = point->rank;
    int are_long = 1;
    for (int k = 0; k < self->m; k++) {
        const zd_row_of_C row = zd_point_row(point, k);
        const double *c = row.x;
        const int n = row.count;
        if (row.column) {               /* packed row: few entries */
            are_long &= zd_dot(n, c, c) > ILL * self->start_square[k];
            continue;
        }
        double squares[4] = {0, 0, 0, 0};
        int i = 0;
        for (; i + 4 <= n; i += 4)
            for (int r = 0; r < 4; r++) squares[r] += c[i + r] * c[i + r];
        for (; i < n; i++) squares[0] += c[i] * c[i];
        are_long &= squares[0] + squares[1] + squares[2] + squares[3] > ILL * self->start_square[k];
    }
    return are_long;
}

void zd_use_all_constraints(zd_point *point)
{
    zd_rank_use_all(point);
    point->known |= ZD_RANKED;
}

/* Reuses the kept selection; returns 0 if there is none that is still valid. */
static int use_kept(zd_point *point)
{
    const zd_rank_monitor *kept = point->rank->kept;
    if (!kept || !kept->is_known || !zd_rank_monitor_is_unchanged(kept, point)) return 0;
    zd_rank_use(point, kept->row, kept->close.m);
    point->known |= ZD_RANKED;
    return 1;
}

/* Finds the independent constraints among more than ZD_FEW_CONSTRAINTS, or where some are redundant. */
static int find_any(zd_point *point)
{
    zd_rank *self = point->rank;
    if (self->is_large) {
        zd_use_all_constraints(point);
        return ZD_DONE;
    }
    int status = zd_point_need(point, ZD_C);
    if (status) return status;
    if (use_kept(point)) return ZD_DONE;
    if (self->max_rank < self->m || self->m > self->n) return reduce(point);
    if (zd_rank_monitor_is_doubtful(self->monitor, point)) return reduce(point);
    zd_use_all_constraints(point);
    return ZD_DONE;
}

int zd_find_independent(zd_point *point)
{
    zd_rank *self = point->rank;
    if (point->known & ZD_RANKED) return ZD_DONE;
    const int are_few = self->m <= ZD_FEW_CONSTRAINTS && self->m == self->max_rank && self->m <= self->n && !point->layout;
    if (!are_few) return find_any(point);
    int status = zd_point_need(point, ZD_C);
    if (status) return status;
    if (ZD_SIZED(are_few_doubtful, self->n, self, point->terms.C)) return reduce(point);
    zd_use_all_constraints(point);
    return ZD_DONE;
}

int zd_discard_selection(zd_point *point)
{
    zd_rank_monitor *kept = point->rank->kept;
    const int are_kept = kept && kept->is_known;
    if (!are_kept) return 0;
    kept->is_known = 0;
    point->known &= ~ZD_RANKED;
    return 1;
}

int zd_rows_find_again(zd_point *point)
{
    point->known &= ~(ZD_RANKED | ZD_FACTORED | ZD_COMPLEMENTED | ZD_ACCELERATED);
    return zd_find_independent(point);
}
