/* Whether a bifurcation lies within a step, though neither of its ends is one.
 *
 * The space that the rows of C span turns as the motion goes on. As long as nothing else happens, it keeps its orientation: with W the
 * squares of the natural units, det(C1 W C0^T) stays positive while it turns by less than a right angle. Where the motion passes through
 * a bifurcation, a row vanishes and comes back reversed: the sign changes, as in the continuation of curves (Allgower and Georg,
 * Introduction to Numerical Continuation Methods, section 8). It changes as well if the mechanism only comes near one and the step
 * leads straight on, where the motion would have turned away.
 *
 * Shorter steps tell which of these it is, in stepping/passage.c: through a bifurcation the motion is continuous, so that one of them
 * ends near enough for limits.c to recognize it; otherwise the orientation changes in one step however short these are.
 */
#include "crossing.h"

#include <math.h>
#include <string.h>

#include "../constraints/rows.h"
#include "../linalg/lu.h"
#include "../linalg/small.h"
#include "../point/matrices.h"
#include "../point/units.h"

enum { MOST_POINTS = 64 };     /* of a path at which C is evaluated */
static const double LONG = 1;       /* in natural units: of a longer path, points in between are evaluated, too */
static const double NEAR = 0.5;     /* in natural units: the distance between these points */
static const double NEARBY = 1e-3;  /* in natural units: a larger violation says that nothing keeps the motion on the constraints */

zd_crossing zd_crossing_take(zd_arena *arena, zd_motion *motion, const zd_last *last)
{
    const zd_system *system = &motion->system;
    size_t m = (size_t)zd_constraints(system), n = (size_t)system->nv, stored = (size_t)zd_size_of_C(system);
    return (zd_crossing){
        .motion = motion,
        .last = last,
        .C = zd_take_doubles(arena, stored),
        .previous = zd_take_doubles(arena, stored),
        .p = zd_take_doubles(arena, (size_t)system->nq),
        .p1 = zd_take_doubles(arena, (size_t)system->nq),
        .v1 = zd_take_doubles(arena, n),
        .turn = zd_take_doubles(arena, m * m),
        .order = zd_take(arena, m * sizeof(int)),
    };
}

int zd_crossing_is_at_one(const zd_point *point)
{
    return point->rank->lost || point->rows < point->rank->most_rows;
}

ZD_INLINE void keep_rows(const int n, const zd_point *point, double *C)
{
    for (int k = 0; k < point->rank->m; k++)
        for (int i = 0; i < n; i++) C[k * n + i] = point->terms.C[k * n + i] * point->unit[i] * point->unit[i];
}

static void keep_packed_rows(const zd_point *point, double *C)
{
    for (int k = 0; k < point->rank->m; k++) {
        zd_row_of_C row = zd_point_row(point, k);
        for (int j = 0; j < row.count; j++) *C++ = row.x[j] * point->unit[row.column[j]] * point->unit[row.column[j]];
    }
}

static void keep(const zd_point *point, double *C)
{
    if (point->layout) keep_packed_rows(point, C);
    else ZD_SIZED(keep_rows, point->rank->n, point, C);
}

/* The sign of rows does not depend on their size. */
ZD_INLINE double turn_of_two(const int n, const zd_point *point, const double *C0)
{
    const double *a = point->C, *b = a + n, *a0 = C0 + zd_rank_row(point, 0) * n, *b0 = C0 + zd_rank_row(point, 1) * n;
    return zd_dot(n, a, a0) * zd_dot(n, b, b0) - zd_dot(n, a, b0) * zd_dot(n, b, a0);
}

/* det(C1 W C0^T), of the rows that count at the point; of more than two in units of their sizes */
static double determinant(const zd_crossing *self, const zd_point *point, const double *C0)
{
    const int n = point->rank->n, rows = point->rows;
    if (rows == 2 && !point->layout) return ZD_SIZED(turn_of_two, n, point, C0);
    for (int a = 0; a < rows; a++)
        for (int b = 0; b < rows; b++) {
            zd_row_of_C now = zd_counted_row(point, a), before = zd_row_in(point, C0, zd_rank_row(point, b));
            self->turn[a * rows + b] = point->inverse_size[zd_rank_row(point, a)] * point->inverse_size[zd_rank_row(point, b)]
                                     * zd_row_product(&now, &before);
        }
    if (rows == 1) return self->turn[0];
    return zd_lu_factor(rows, self->turn, self->order) == rows ? zd_lu_determinant(rows, self->turn, self->order) : 0;
}

/* p <- the cubic through the ends of the step with the rates there, at this share s of the step. */
static void interpolate(const zd_crossing *self, double h, double s)
{
    for (int i = 0; i < self->motion->system.nq; i++) {
        double p0 = self->last->p[i], moved = self->p1[i] - p0, m0 = h * self->rate0[i] - moved, m1 = moved - h * self->rate1[i];
        self->p[i] = p0 + s * (moved + (1 - s) * ((1 - s) * m0 + s * m1));
    }
}

/* Whether the orientation is the same from point to point, on a path too long to tell from its ends alone. */
static int follow(zd_crossing *self, double h, int points, int *is_kept)
{
    zd_point *point = self->motion->point;
    const int n = point->rank->n;
    const double t1 = point->t;
    memcpy(self->p1, point->p, (size_t)self->motion->system.nq * sizeof(double));
    memcpy(self->v1, point->v, (size_t)n * sizeof(double));
    memcpy(self->previous, self->C, (size_t)zd_size_of_C(point->system) * sizeof(double));
    int status = ZD_DONE;
    *is_kept = 1;
    for (int i = 1; i <= points && *is_kept && !status; i++) {
        interpolate(self, h, (double)i / points);
        zd_point_move(point, i == points ? t1 : t1 - h * (points - i) / points, i == points ? self->p1 : self->p, self->v1);
        status = zd_point_need(point, ZD_C);
        if (!status) status = zd_rows_find(point);
        *is_kept = status == ZD_DONE && !zd_crossing_is_at_one(point) && determinant(self, point, self->previous) > 0;
        keep(point, self->previous);
    }
    zd_point_move(point, t1, self->p1, self->v1);
    return status == ZD_BIFURCATION ? ZD_DONE : status;
}

/* What a change of orientation means: a bifurcation, but nothing far off the constraints, where nothing keeps the motion on them. */
static int judge(const zd_crossing *self)
{
    zd_point *point = self->motion->point;
    int status = zd_point_need(point, ZD_PHI | ZD_C);
    if (status) return status;
    return self->constraints_hold || !point->system->mh || zd_point_violation(point) <= NEARBY ? ZD_BIFURCATION_PASSED : ZD_DONE;
}

int zd_crossing_begin(zd_crossing *self)
{
    self->has_rows = 0;
    return zd_crossing_step(self, 0, 0);
}

double zd_crossing_orientation(const zd_crossing *self)
{
    return determinant(self, self->motion->point, self->C);
}

int zd_crossing_step(zd_crossing *self, double h, double moved)
{
    zd_point *point = self->motion->point;
    if (!point->rank->m) return ZD_DONE;
    int is_kept = 1;
    /* What the next step begins with is evaluated at once. */
    int status = point->known & ZD_C ? ZD_DONE : zd_point_need(point, self->motion->acceleration_needs);
    if (!status && !(point->known & ZD_RANKED)) status = zd_rows_find(point);
    if (status) return status;
    if (zd_crossing_is_at_one(point)) {
        self->has_rows = 0;
        return ZD_DONE;
    }
    if (self->has_rows && !self->may_pass) {
        if (moved <= LONG * LONG) is_kept = determinant(self, point, self->C) > 0;
        else status = follow(self, h, (int)fmin(1 + sqrt(moved) / NEAR, MOST_POINTS), &is_kept);
    }
    if (!status && !is_kept) status = judge(self);
    if (status) return status;
    keep(point, self->C);
    self->has_rows = 1;
    return ZD_DONE;
}
