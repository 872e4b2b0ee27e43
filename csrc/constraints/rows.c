#include "rows.h"

#include <math.h>

#include "../linalg/norms.h"
#include "../linalg/small.h"
#include "../point/matrices.h"
#include "limits.h"
#include "packed.h"

static const double SQUARED = ZD_RANK_TOLERANCE * ZD_RANK_TOLERANCE, DOUBTFUL = ZD_DOUBTFUL * ZD_DOUBTFUL;
static const double ILL = ZD_ILL_CONDITIONED * ZD_ILL_CONDITIONED;

zd_rank *zd_rows_take(zd_arena *arena, const zd_system *system, int may_be_deficient)
{
    zd_limits *limits = may_be_deficient ? zd_limits_take(arena, system) : NULL;
    zd_rank *self = zd_rank_take(arena, system);
    if (self) self->limits = limits;
    return self;
}

static int reduce(zd_point *point)
{
    static const double region = ZD_LIMITS_REGION * ZD_LIMITS_REGION;
    zd_rank *self = point->rank;
    self->was_doubtful = 1;
    int status = zd_point_need(point, ZD_M);
    if (status) return status;
    if (!zd_is_finite(zd_size_of_C(point->system), point->terms.C)) return ZD_NOT_FINITE;
    int by_limits = self->is_started && self->limits;
    zd_rank_choose(point, by_limits ? region : SQUARED);
    if (by_limits && point->rows < self->most_rows) {
        status = zd_limits_find(point);
        if (!status && !self->lost) zd_rank_choose(point, SQUARED);
    }
    int is_deficient = self->lost || point->rows < self->most_rows;
    self->was_deficient |= is_deficient;
    if (is_deficient && !self->may_be_deficient) return ZD_BIFURCATION;
    if (!status) point->known |= ZD_RANKED;
    return status;
}

/* In the plain metric, and in the order of the rows: whether any might be one of those before it. */
ZD_INLINE int is_doubtful(const int n, zd_rank *self, const double *C)
{
    int m = self->m, is_ill = 0;
    double *square = self->square, *left = self->square_left;
    for (int k = 0; k < m; k++) {
        square[k] = zd_dot(n, C + k * n, C + k * n);
        if (!(square[k] > DOUBTFUL * self->start_square[k])) return self->was_ill_conditioned = 1;
        is_ill |= !(square[k] > ILL * self->start_square[k]);
    }
    self->was_ill_conditioned |= is_ill;
    if (m < 2) return 0;
    double along = zd_dot(n, C, C + n);
    if (m == 2) {           /* without the divisions of what follows */
        double both = square[0] * square[1];
        self->was_ill_conditioned |= !((1 - ILL) * both > along * along);
        return !((1 - DOUBTFUL) * both > along * along);
    }
    for (int k = 0; k < m; k++) {
        double *q = self->Q + k * n;
        zd_copy(n, C + k * n, q);
        for (int j = 0; j < k; j++) zd_add_scaled(n, q, -zd_dot(n, self->Q + j * n, q) / left[j], self->Q + j * n);
        left[k] = zd_dot(n, q, q);
        if (!(left[k] > ILL * square[k])) self->was_ill_conditioned = 1;
        if (!(left[k] > DOUBTFUL * square[k])) return 1;
    }
    return 0;
}

static int are_doubtful(zd_point *point)
{
    zd_rank *self = point->rank;
    return point->layout ? zd_packed_rows_are_doubtful(point) : ZD_SIZED(is_doubtful, self->n, self, point->terms.C);
}

int zd_rows_find(zd_point *point)
{
    zd_rank *self = point->rank;
    if (point->known & ZD_RANKED) return ZD_DONE;
    int status = zd_point_need(point, ZD_C);
    if (status) return status;
    if (self->most_rows < self->m || are_doubtful(point)) return reduce(point);
    zd_rank_use_all(point);
    point->known |= ZD_RANKED;
    return ZD_DONE;
}

int zd_rows_find_again(zd_point *point)
{
    point->known &= ~(ZD_RANKED | ZD_FACTORED | ZD_COMPLEMENTED | ZD_ACCELERATED);
    return zd_rows_find(point);
}
