/* Bifurcations inside a step, when neither of its ends is one.
 *
 * The row space of C rotates with the motion but keeps its orientation: with W the squares of the characteristic scales, det(C1 W C0^T)
 * stays positive while the rotation is below a right angle. In a bifurcation a row of C vanishes and returns reversed, so that the sign
 * changes, as in the continuation of curves (Allgower and Georg, Introduction to Numerical Continuation Methods, section 8). The sign
 * changes, too, if the mechanism only comes near a bifurcation and the step goes straight on where the exact motion turns away.
 *
 * If constraints are redundant, the independent rows that were selected may become dependent, and so reversed, without a bifurcation:
 * other rows then take their place. So all rows are compared. With C1 = B C1_r, where B = [I; T], the product of those eigenvalues of
 * C1 W C0^T that are not identically zero is det(C1_r W C0^T B). It is the sum of det(C1_s W C0_s^T) over all selections s of rows and
 * does not depend on the one in use; it stays positive while neither the row space nor the dependence between rows rotates by a right angle.
 *
 * With more than two constraints the determinant is computed only after a noticeable rotation between consecutive points of the step: see
 * where `was_turned` of a rank is set.
 *
 * Shorter steps distinguish the two cases, in step/passage.c: through a bifurcation the motion is continuous, so that one of them
 * ends near enough for limits.c to recognize it; otherwise the orientation changes in one step, however short the steps are.
 */
#include "safeguards.h"

#include <math.h>

#include "../constraints/rank.h"
#include "../constraints/rank_monitor.h"
#include "../linalg/dense.h"
#include "../linalg/small.h"
#include "../point/point.h"

enum { MAX_POINTS = 64 };     /* maximum number of points at which C is evaluated along a long displacement */
static const double LONGEST = 1;    /* displacement in characteristic scales: along a longer one, intermediate points are evaluated */
static const double NEAR = 0.5;     /* in characteristic scales: distance of these points */
static const double NEARBY = 1e-3;  /* in characteristic scales: with a larger violation the motion is not held on the constraints */

static zd_crossing_memory *create_memory(zd_arena *arena, const zd_motion *motion)
{
    const zd_system *system = &motion->system;
    const int has_turn = !zd_has_many_constraints(motion->formulation, system);
    const size_t m = zd_constraints(system), n = system->nv, stored = zd_size_of_C(system);
    zd_crossing_memory self = {
        .C = zd_arena_doubles(arena, stored),
        .previous = zd_arena_doubles(arena, stored),
        .p = zd_arena_doubles(arena, system->nq),
        .p1 = zd_arena_doubles(arena, system->nq),
        .v1 = zd_arena_doubles(arena, n),
        .turn = zd_arena_doubles(arena, has_turn ? m * m : 0),
        .order = zd_arena_ints(arena, m),
    };
    return zd_arena_copy(arena, &self, sizeof self);
}

static int are_few(const zd_system *system) { return zd_constraints(system) <= ZD_FEW_CONSTRAINTS; }

zd_crossing zd_crossing_create(zd_arena *arena, zd_motion *motion, const zd_last *last)
{
    const zd_system *system = &motion->system;
    return (zd_crossing){.motion = motion, .last = last, .memory = create_memory(arena, motion),
                         .keeps_rows = are_few(system)};
}

int zd_crossing_is_at_one(const zd_point *point)
{
    return point->rank->lost || point->rows < point->rank->max_rank;
}

ZD_INLINE void keep_rows(const int n, const int m, const zd_point *point, double *C)
{
    for (int k = 0; k < m; k++)
        for (int i = 0; i < n; i++) C[k * n + i] = point->terms.C[k * n + i] * point->unit[i] * point->unit[i];
}

static void keep_packed_rows(const zd_point *point, double *C)
{
    for (int k = 0; k < point->rank->m; k++) {
        zd_row_of_C row = zd_point_row(point, k);
        for (int j = 0; j < row.count; j++) *C++ = row.x[j] * point->unit[row.column[j]] * point->unit[row.column[j]];
    }
}

static void store_rows(const zd_point *point, double *C)
{
    if (point->layout) keep_packed_rows(point, C);
    else ZD_SIZED(keep_rows, point->rank->n, point->rank->m, point, C);
}

/* memory->C <- C at the start of the step, evaluated again; the point's scratch is then brought back to its state. */
static int evaluate_beginning(zd_crossing *self)
{
    const zd_system *system = &self->motion->system;
    const zd_last *last = self->last;
    zd_point *point = self->motion->point, there = *point;
    there.terms.C = self->memory->previous;
    point->known &= ~ZD_MOVED;
    if (system->evaluate(system->data, ZD_C | ZD_MOVED, last->t, last->p, last->v, &there.terms)) return ZD_CALLBACK;
    store_rows(&there, self->memory->C);
    return zd_point_need_missing(point, 0);
}

int zd_crossing_need_rows(zd_crossing *self)
{
    if (self->has_rows) return ZD_DONE;
    const int status = evaluate_beginning(self);
    self->has_rows = !status;
    self->keeps_rows = 1;
    return status;
}

/* det(C1 W C0^T) of two rows. Rows need no scaling: only the sign is used. */
ZD_INLINE double turn_of_two(const int n, const zd_point *point, const double *a0, const double *b0)
{
    const double *a = point->C, *b = a + n;
    return zd_dot(n, a, a0) * zd_dot(n, b, b0) - zd_dot(n, a, b0) * zd_dot(n, b, a0);
}

/* x (count,) <- row a of C1_r W C0^T, with rows scaled by their sizes; columns: independent constraints at the point, then redundant ones */
static void multiply_row(const zd_point *point, const double *C0, int a, int count, double *x)
{
    const zd_row_of_C now = zd_counted_row(point, a);
    for (int b = 0; b < count; b++) {
        const int row = b < point->rows ? zd_independent_constraint(point, b) : point->rank->selection->row[b];
        const zd_row_of_C before = zd_row_in(point, C0, row);
        x[b] = point->inverse_size[zd_independent_constraint(point, a)] * point->inverse_size[row] * zd_row_product(&now, &before);
    }
}

/* x <- x B, in the same scaling */
static void gather_others(const zd_point *point, double *x)
{
    const zd_selection *selection = point->rank->selection;
    for (int d = point->rows; d < selection->m; d++) {
        const int row = selection->row[d];
        const double *T = selection->G + row * selection->m, share = x[d] * point->inverse_size[row];
        for (int b = 0; b < point->rows; b++) x[b] += share * T[b] * point->size[selection->row[b]];
    }
}

/* det(C1_r W C0^T B): C1_r of the independent constraints at the point, B expresses the redundant ones; more than two rows are scaled */
static double determinant(const zd_crossing *self, const zd_point *point, const double *C0)
{
    const int n = point->rank->n, rows = point->rows, is_mixed = !zd_rank_is_full(point) && !point->rank->lost;
    if (rows == 2 && !point->layout && !is_mixed)
        return ZD_SIZED(turn_of_two, n, point, C0 + zd_independent_constraint(point, 0) * n, C0 + zd_independent_constraint(point, 1) * n);
    double *turn = self->memory->turn;
    if (is_mixed) zd_rank_express_others(point);
    for (int a = 0; a < rows; a++) {        /* the redundant part of row a is overwritten by row a + 1 */
        multiply_row(point, C0, a, is_mixed ? point->rank->m : rows, turn + a * rows);
        if (is_mixed) gather_others(point, turn + a * rows);
    }
    if (rows == 1) return turn[0];
    int *order = self->memory->order;
    return zd_lu_factor(rows, turn, order) == rows ? zd_lu_determinant(rows, turn, order) : 0;
}

/* memory->p <- cubic Hermite interpolant of the step at the fraction s. */
static void interpolate(const zd_crossing *self, double h, double s)
{
    const double *p1 = self->memory->p1;
    for (int i = 0; i < self->motion->system.nq; i++) {
        double p0 = self->last->p[i], moved = p1[i] - p0, m0 = h * self->rate0[i] - moved, m1 = moved - h * self->rate1[i];
        self->memory->p[i] = p0 + s * (moved + (1 - s) * ((1 - s) * m0 + s * m1));
    }
}

/* *is_kept <- true if the orientation is the same from point to point along a long displacement, whose ends alone prove nothing. */
static int follow(zd_crossing *self, double h, int points, int *is_kept)
{
    zd_point *point = self->motion->point;
    const zd_crossing_memory *memory = self->memory;
    const int n = point->rank->n;
    const double t1 = point->t;
    zd_copy_all(self->motion->system.nq, point->p, memory->p1);
    zd_copy_all(n, point->v, memory->v1);
    zd_copy_all(zd_size_of_C(point->system), memory->C, memory->previous);
    int status = ZD_DONE;
    *is_kept = 1;
    for (int i = 1; i <= points && *is_kept && !status; i++) {
        interpolate(self, h, (double)i / points);
        zd_point_move(point, i == points ? t1 : t1 - h * (points - i) / points, i == points ? memory->p1 : memory->p, memory->v1);
        status = zd_point_need(point, ZD_C);
        if (!status) status = zd_find_independent(point);
        *is_kept = status == ZD_DONE && !zd_crossing_is_at_one(point) && determinant(self, point, memory->previous) > 0;
        store_rows(point, memory->previous);
    }
    zd_point_move(point, t1, memory->p1, memory->v1);
    return status == ZD_BIFURCATION ? ZD_DONE : status;
}

/* Status after a change of orientation: a bifurcation, unless the motion is not held on the constraints and violates them. */
static int judge(const zd_crossing *self)
{
    zd_point *point = self->motion->point;
    int status = zd_point_need(point, ZD_PHI | ZD_C);
    if (status) return status;
    return self->constraints_hold || !point->system->mh || zd_point_violation(point) <= NEARBY ? ZD_BIFURCATION_PASSED : ZD_DONE;
}

int zd_crossing_begin(zd_crossing *self)
{
    self->has_begun = 0;
    return zd_crossing_step(self, 0, 0);
}

double zd_crossing_orientation(const zd_crossing *self)
{
    return determinant(self, self->motion->point, self->memory->C);
}

/* *is_kept <- true if the rows of C at both ends of the step have the same orientation. */
static int compare(zd_crossing *self, double h, double moved, int *is_kept)
{
    const zd_point *point = self->motion->point;
    int status = zd_crossing_need_rows(self);
    if (status) return status;
    if (moved > LONGEST * LONGEST) return follow(self, h, (int)fmin(1 + sqrt(moved) / NEAR, MAX_POINTS), is_kept);
    *is_kept = determinant(self, point, self->memory->C) > 0;
    return ZD_DONE;
}

/* Saves the end of the step as the start of the next. */
static void keep(zd_crossing *self)
{
    const zd_point *point = self->motion->point;
    self->has_begun = 1;
    self->has_rows = self->keeps_rows;
    if (self->has_rows) store_rows(point, self->memory->C);
    point->rank->was_turned = !(point->known & ZD_RANKED);     /* not ranked after intermediate points were evaluated */
}

/* True for the usual case of a plane loop: two independent constraints at both ends of a short step. */
static int is_ordinary(const zd_crossing *self, double moved)
{
    const zd_point *point = self->motion->point;
    return point->rank->m == ZD_FEW_CONSTRAINTS && zd_rank_is_full(point) && !point->layout && self->has_begun && self->has_rows
        && !self->may_pass && moved <= LONGEST * LONGEST;
}

/* Saves two rows if they have the orientation of the saved ones; returns false otherwise. */
ZD_INLINE int keep_two(const int n, const zd_point *point, double *C0)
{
    if (!(turn_of_two(n, point, C0, C0 + n) > 0)) return 0;
    keep_rows(n, 2, point, C0);
    return 1;
}

int zd_crossing_step(zd_crossing *self, double h, double moved)
{
    zd_motion *motion = self->motion;
    zd_point *point = motion->point;
    if (!point->rank->m || point->rank->is_large) return ZD_DONE;
    int is_kept = 1;
    /* All terms that the next step needs at its start are evaluated in the same call. */
    int status = point->known & ZD_C ? ZD_DONE : zd_point_need(point, motion->acceleration_needs);
    if (!status && !(point->known & ZD_RANKED)) status = zd_motion_find_independent(motion);
    if (status) return status;
    if (is_ordinary(self, moved) && ZD_SIZED(keep_two, point->rank->n, point, self->memory->C)) return ZD_DONE;
    if (zd_crossing_is_at_one(point)) {
        self->has_begun = self->has_rows = 0;
        return ZD_DONE;
    }
    zd_rank_monitor_compare(point);
    const int may_differ = point->rank->was_turned || moved > LONGEST * LONGEST || are_few(&motion->system);
    if (self->has_begun && !self->may_pass && may_differ) status = compare(self, h, moved, &is_kept);
    if (!status && !is_kept) status = judge(self);
    if (!status) keep(self);
    return status;
}
