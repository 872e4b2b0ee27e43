/* (13) without dense matrices:
 *
 *     W = M^-1                                block by block
 *     S = C W C^T                             blocks of pairs of groups that touch the same body: point/sparse/weighted.c
 *     S lambda = C W (f - d) - xi,   vdot = W (f - d - C^T lambda)
 *
 * S has the squared condition number of the constraints, which the orthogonalization in schur.c avoids; and W amplifies the rounding of
 * large reactions on a light body. Both can be detected: by a small pivot of S, and by a row of C to which its bodies contribute
 * unequally. In either case the solution is verified with C vdot = xi and refined with the same factors until the residual is rounding.
 *
 * The smallest pivot of a long chain is small because of its length alone, and its solutions are accurate. Verification requires C,
 * which is not stored otherwise, and takes as long as everything else: so systems with many constraints that were found accurate are
 * verified again only after a number of factorizations that doubles each time, or as soon as the pivot has halved.
 */
#include "structured.h"

#include <math.h>
#include <string.h>

#include "../../constraints/rank.h"
#include "../../linalg/iteration.h"
#include "../../linalg/small.h"
#include "../../point/point.h"

enum { LONGEST_WAIT = 251 };  /* largest number of factorizations between verifications: a prime, so that all stages of a step are covered */
static const double ACCURATE_RESIDUAL = 64 * 0x1p-52;        /* residual relative to the terms of C x of accurate solutions */

zd_schur_blocks *zd_schur_blocks_create(zd_arena *arena, const zd_system *system)
{
    const zd_structure *structure = system->structure;
    int rows = 0;
    for (int g = 0; structure && g < structure->groups; g++) rows += structure->rows[g];
    const int has_redundant = rows != zd_constraints(system);
    if (!structure || (has_redundant && zd_rank_is_of_many(system))) return NULL;
    size_t n = system->nv, m = rows, of_redundant = has_redundant ? m : 0;
    zd_schur_blocks self = {
        .n = (int)n,
        .m = (int)m,
        .W = zd_arena_doubles(arena, zd_size_of_M(system)),
        .is_diagonal = zd_mass_is(system, ZD_DIAGONAL),
        .is_constant = zd_mass_is(system, ZD_CONSTANT),
        .force = zd_arena_doubles(arena, n),
        .lambda = zd_arena_doubles(arena, m),
        .residual = zd_arena_doubles(arena, m),
        .step = zd_arena_doubles(arena, n),
        .least = zd_rank_is_of_many(system) ? NULL : zd_arena_doubles(arena, m),
        .has_redundant = has_redundant,
        .rhs_of_all = zd_arena_doubles(arena, of_redundant),
        .lambda_of_all = zd_arena_doubles(arena, of_redundant),
    };
    return zd_arena_copy(arena, &self, sizeof self);
}

/* ---- right-hand sides ---- */

/* x <- W y */
static void times_W(const zd_schur_blocks *self, const double *y, double *restrict x)
{
    const double *W = self->W;
    const int entries = self->is_diagonal ? self->n : 0;
    for (int i = 0; i < entries; i++) x[i] = W[i] * y[i];
    if (!self->is_diagonal) zd_mass_solve(self->layout, W, y, x);
}

/* y <- C x - rhs in the order of S, x NULL: zero */
static void find_right_side(zd_schur_blocks *self, const double *x, const double *rhs, double *y)
{
    if (!self->products) {
        zd_weighted_times(self->weighted, self->C, x, rhs, y);
        return;
    }
    if (x) self->products->times_C(self->data, &self->terms, x, self->lambda);
    zd_row_groups_gather(&self->weighted->row_groups, x ? self->lambda : NULL, rhs, y);
}

/* x <- W force, and y of S lambda = y */
static double *begin(zd_schur_blocks *self, const zd_right_side *of)
{
    double *y = self->weighted->blocks->x;
    if (of->force) times_W(self, of->force, of->x);
    find_right_side(self, of->force ? of->x : NULL, of->rhs, y);
    return y;
}

/* ---- factors ---- */

static int invert_mass(zd_schur_blocks *self, zd_point *point)
{
    if (self->is_known && self->is_constant) return ZD_DONE;
    int status = zd_point_need(point, ZD_M | ZD_C);
    if (status) return status;
    point->failed_index = zd_mass_factor(point, self->W);
    if (point->failed_index < self->n) return ZD_NOT_DEFINITE;
    self->is_accurate = zd_weighted_is_alike(self->weighted, self->C, self->W, self->residual, self->lambda);
    self->is_known = 1;
    return ZD_DONE;
}

/* Factors S of the selected constraints, whose C is evaluated. Pending right-hand sides have another order and are not eliminated. */
static zd_pivots factor_chosen(zd_schur_blocks *self)
{
    const zd_selection *chosen = self->chosen;
    memset(self->without, 0, self->weighted->blocks->rows);
    for (int d = chosen->independent; d < self->m; d++) self->without[self->weighted->row_groups.place[chosen->row[d]]] = 1;
    self->begun = (zd_right_side){NULL, NULL, NULL};
    return zd_weighted_factor_without(self->weighted, self->C, self->W, self->without);
}

/* Forms and factors S, and eliminates the pending right-hand side. C is evaluated before, or a call with ZD_MOVED has left the system's
 * own data in its scratch memory. */
static int factor(zd_schur_blocks *self, zd_point *point, zd_pivots *pivots)
{
    int status = !self->products ? zd_point_need(point, ZD_C) : point->known & ZD_MOVED ? ZD_DONE : zd_point_need_missing(point, 0);
    if (status) return status;
    if (self->chosen) {
        *pivots = factor_chosen(self);
        return ZD_DONE;
    }
    double *y = point->awaited.x ? begin(self, &point->awaited) : NULL;
    self->begun = point->awaited;
    *pivots = self->products ? zd_weighted_factor_by(self->weighted, self->products, self->data, &self->terms, self->W, y)
                             : zd_weighted_factor(self->weighted, self->C, self->W, y);
    return ZD_DONE;
}

/* True if solutions with these factors are to be verified. */
static int is_to_be_compared(zd_schur_blocks *self)
{
    if (!self->is_accurate || (self->share < ZD_GOOD_PIVOT && self->least)) return 1;
    if (!(self->share < ZD_GOOD_PIVOT)) return 0;
    if (--self->wait > 0 && self->share > self->compared_share / 2) return 0;
    self->compared_share = self->share;
    self->pause = self->pause < LONGEST_WAIT / 2 ? 2 * self->pause + 1 : LONGEST_WAIT;
    self->wait = self->pause;
    return 1;
}

/* Allocates the symbolic structure at the first call; returns 0 without memory. */
static int has_symbolic(zd_schur_blocks *self, const zd_point *point)
{
    zd_store *store = point->rank->store;
    if (!self->weighted) self->weighted = zd_weighted_create(store, point->layout);
    if (self->weighted && self->has_redundant && !self->without) self->without = zd_store_bytes(store, self->weighted->blocks->rows);
    return self->weighted && (self->without || !self->has_redundant);
}

int zd_schur_blocks_factor(zd_schur_blocks *self, zd_point *point)
{
    zd_pivots pivots;
    if (!has_symbolic(self, point)) return ZD_NO_MEMORY;
    self->layout = point->layout;
    self->C = point->terms.C;
    self->chosen = self->without && !zd_rank_is_full(point) ? point->rank->selection : NULL;
    self->products = self->chosen ? NULL : zd_weighted_products(self->weighted, point->system);
    self->data = point->system->data;
    self->terms = point->terms;
    int status = invert_mass(self, point);
    if (!status) status = factor(self, point, &pivots);
    if (status) return status;
    self->share = pivots.failed < 0 ? pivots.pivot / pivots.diagonal : 0x1p-52;     /* upper bound: rounding */
    self->smallest = pivots.failed < 0 ? pivots.smallest : pivots.failed;
    self->is_compared = pivots.failed >= 0 || is_to_be_compared(self);
    if (pivots.failed < 0) return self->is_compared ? zd_point_need(point, ZD_C) : ZD_DONE;
    point->failed_index = zd_weighted_row(self->weighted, pivots.failed);
    return ZD_DEPENDENT_ROWS;
}

/* S_kk = sum_i W_i C_ki^2 is at most |C_k|^2 times the largest of these W_i. */
static void find_least(zd_schur_blocks *self, const zd_point *point)
{
    for (int k = 0; k < self->m; k++) {
        const zd_row_of_C row = zd_packed_row(self->layout, self->C, k);
        double most = 0;
        for (int j = 0; j < row.count; j++) most = fmax(most, self->W[row.column[j]]);
        self->least[self->weighted->row_groups.place[k]] = ZD_ILL_CONDITIONED * ZD_ILL_CONDITIONED * point->rank->start_square[k] * most;
    }
    self->is_least_known = 1;
}

int zd_schur_blocks_find_long_rows(zd_schur_blocks *self, zd_point *point)
{
    const int is_applicable = self->least && self->is_diagonal && self->is_constant && !zd_weighted_has_welds(self->weighted);
    if (is_applicable && point->rank->is_started && !self->is_least_known) {
        find_least(self, point);
        return zd_schur_blocks_has_long_rows(self, point);
    }
    return zd_point_need(point, ZD_C) == ZD_DONE && zd_rows_are_long(point);
}

/* ---- solution ---- */

/* x <- x - W C^T y, y in the order of S */
static void subtract_weighted(zd_schur_blocks *self, const double *y, double *x)
{
    const zd_row_groups *row_groups = &self->weighted->row_groups;
    if (!self->products) {
        zd_row_groups_subtract(row_groups, self->C, self->W, y, x);
        return;
    }
    self->products->subtract_weighted(self->data, &self->terms, self->W, y, row_groups->place, x);
}

/* x <- W (force - C^T lambda), from x and y of begin(), y after zd_blocks_forward() */
static void finish(zd_schur_blocks *self, const double *force, double *x)
{
    double *y = self->weighted->blocks->x;
    const size_t bytes = self->n * sizeof *x;
    zd_blocks_backward(self->weighted->blocks, y);
    if (self->is_diagonal) {
        if (!force) memset(x, 0, bytes);
        subtract_weighted(self, y, x);                                                      /* (13), (27) */
        return;
    }
    if (force) memcpy(self->force, force, bytes);
    else memset(self->force, 0, bytes);
    zd_row_groups_subtract(&self->weighted->row_groups, self->C, NULL, y, self->force);
    times_W(self, self->force, x);                                                          /* (13), (27) */
}

/* residual <- rhs - C x; returns the largest entry relative to its terms, 0 if it is within the rounding of x. */
static double find_residual(const zd_schur_blocks *self, const double *rhs, const double *x, double *residual)
{
    double left = 0;
    for (int k = 0; k < self->m; k++) {
        residual[k] = 0;
        if (self->chosen && self->without[self->weighted->row_groups.place[k]]) continue;
        double size;
        const double sum = residual[k] = zd_packed_row_residual(self->layout, self->C, k, rhs, x, &size);
        if (fabs(sum) > ZD_RESIDUAL_ROUNDING * size && fabs(sum) > left * size) left = fabs(sum) / size;
    }
    return left;
}

static void add_multipliers(zd_schur_blocks *self, double *lambda)
{
    zd_row_groups_scatter(&self->weighted->row_groups, self->weighted->blocks->x, self->residual);
    for (int k = 0; k < self->m; k++) lambda[k] += self->residual[k];
}

static void refine(zd_schur_blocks *self, const double *rhs, double *x, double *lambda)
{
    double before = INFINITY, left = find_residual(self, rhs, x, self->residual);
    if (left > ACCURATE_RESIDUAL) self->wait = self->pause = 0;
    for (int i = 0; i < ZD_MAX_REFINEMENTS && left > 0 && left < 0.5 * before; i++) {
        zd_blocks_forward(self->weighted->blocks, begin(self, &(zd_right_side){NULL, self->residual, self->step}));
        finish(self, NULL, self->step);
        for (int j = 0; j < self->n; j++) x[j] += self->step[j];
        if (lambda) add_multipliers(self, lambda);
        before = left;
        left = find_residual(self, rhs, x, self->residual);
    }
}

static void solve_all(zd_schur_blocks *self, const double *force, const double *rhs, double *x, double *lambda)
{
    const zd_right_side *begun = &self->begun;
    const int has_begun = begun->x == x && begun->rhs == rhs && begun->force == force;
    if (!has_begun) zd_blocks_forward(self->weighted->blocks, begin(self, &(zd_right_side){force, rhs, x}));
    self->begun = (zd_right_side){NULL, NULL, NULL};
    finish(self, force, x);
    if (lambda) zd_row_groups_scatter(&self->weighted->row_groups, self->weighted->blocks->x, lambda);
    if (self->is_compared) refine(self, rhs, x, lambda);
}

void zd_schur_blocks_solve(zd_schur_blocks *self, const double *force, const double *rhs, double *x, double *lambda)
{
    const zd_selection *chosen = self->chosen;
    if (!chosen) {
        solve_all(self, force, rhs, x, lambda);
        return;
    }
    zd_clear(self->m, self->rhs_of_all);
    for (int a = 0; a < chosen->independent; a++) self->rhs_of_all[chosen->row[a]] = rhs[a];
    solve_all(self, force, self->rhs_of_all, x, lambda ? self->lambda_of_all : NULL);
    for (int a = 0; lambda && a < chosen->independent; a++) lambda[a] = self->lambda_of_all[chosen->row[a]];
}
