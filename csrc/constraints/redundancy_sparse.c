/* Redundant constraints of a structure with many, at a cost proportional to these.
 *
 * Pivots of S = C U^2 C^T, U diagonal, are the squared residual norms of the rows after those eliminated before are projected out: the
 * pivot of a dependent row is rounding, which grows along a chain. So all rows with small pivots are set aside as candidates. Then a
 * random velocity is projected onto the null space of the others, repeatedly until these are satisfied to rounding: it satisfies a row
 * that is dependent on them, too, and with probability one no other. If it violates a candidate, an independent row was set aside, and
 * rows that depend on it may have been missed: the search is repeated with a smaller threshold.
 *
 * U holds displacements of comparable size for all bodies. A length is the same for all of them, and the angle of each body is such that
 * its longest arm moves by as much. With the length of the whole mechanism, as in the characteristic scales, the residuals due to angles
 * would all be small in a long one.
 *
 * A row that is dependent here is redundant if it is so in all positions: then accelerations that satisfy the others satisfy it at any
 * velocity, (6), and so at this random one. Otherwise it is dependent in this position only, a bifurcation.
 */
#include "rank.h"

#include <limits.h>
#include <math.h>
#include <string.h>

#include "../linalg/small.h"
#include "../point/point.h"
#include "../point/sparse/weighted.h"

enum { PROJECTIONS = 6 };
static const double SMALL_PIVOTS[] = {0x1p-20, 0x1p-30, 0x1p-40}; /* relative to the squared row: candidates for dependent rows */
static const double NEGLIGIBLE_ARM = 0x1p-20;               /* arm relative to the mechanism's length: a shorter one counts as zero */
static const double SATISFIED_BY_VELOCITY = 0x1p-28;        /* residual relative to its terms: the row is satisfied */
static const double ZERO_VELOCITY = 0x1p-14;                /* velocity relative to those before the projection: zero */
/* in characteristic scales: a smaller xi is of velocities that are rounding error */
static const double ZERO_XI = 0x1p-52;
static const double SATISFIED_BY_ACCELERATION = 0x1p-20;    /* residual relative to the largest term of (6): the row is satisfied */

typedef struct search {
    zd_store store;
    zd_layout whole;        /* layout, finally without bodies split into several */
    zd_weighted *weighted;
    double *unit;           /* (nv,): the diagonal of U, */
    double *U;              /* and its square, stored as M is */
    double *x, *change;     /* (nv,) */
    double *v0, *v;         /* (nv,): velocity at the start, and a random one */
    unsigned char *candidate;   /* (m,) */
} search;

static void *create(zd_arena *arena, const void *of)
{
    const zd_system *system = of;
    search self = {
        .unit = zd_arena_doubles(arena, system->nv),
        .U = zd_arena_doubles(arena, zd_size_of_M(system)),
        .x = zd_arena_doubles(arena, system->nv),
        .change = zd_arena_doubles(arena, system->nv),
        .v0 = zd_arena_doubles(arena, system->nv),
        .v = zd_arena_doubles(arena, system->nv),
        .candidate = zd_arena_bytes(arena, zd_constraints(system)),
    };
    return zd_arena_copy(arena, &self, sizeof self);
}

static int is_length(const zd_system *system, int i) { return system->lengths && system->lengths[system->nq + i]; }

/* Longest arm of each block: the entry of an angle over the largest entry of a length in its row. Returns the shortest of these, 0 if
 * there are none. */
static double find_arms(const zd_point *point, double *arm)
{
    const zd_system *system = point->system;
    const zd_layout *layout = point->layout;
    double shortest = INFINITY, length = 0;
    for (int b = 0; b < layout->blocks; b++) arm[b] = 0;
    for (int k = 0; k < zd_constraints(system); k++) {
        const zd_row_of_C row = zd_point_row(point, k);
        double shift = 0;
        for (int j = 0; j < row.count; j++)
            if (is_length(system, row.column[j])) shift = fmax(shift, fabs(row.x[j]));
        for (int j = 0; j < row.count && shift > 0; j++) {
            double *of_block = arm + layout->block_of[row.column[j]];
            if (!is_length(system, row.column[j])) *of_block = fmax(*of_block, fabs(row.x[j]) / shift);
        }
    }
    for (int i = 0; i < system->nv; i++)
        if (is_length(system, i)) length = point->unit[i];
    for (int b = 0; b < layout->blocks; b++)
        if (arm[b] > NEGLIGIBLE_ARM * length) shortest = fmin(shortest, arm[b]);
    return shortest < INFINITY ? shortest : 0;
}

/* Scales U: angles of bodies without arms get the characteristic scale, all others a smaller one. */
static void set_units(search *self, const zd_point *point)
{
    const double *arm = self->change, shortest = find_arms(point, self->change);
    for (int i = 0; i < point->system->nv; i++) {
        const double own = arm[point->layout->block_of[i]];
        self->unit[i] = !(shortest > 0) ? point->unit[i] : is_length(point->system, i) ? shortest : own > shortest ? shortest / own : 1;
    }
}

static void set_metric(search *self, const zd_point *point)
{
    const zd_layout *layout = point->layout;
    set_units(self, point);
    zd_set_identity(point->system, self->U);
    for (int b = 0; b < layout->blocks; b++) {
        const int first = layout->velocity_at[b], n = layout->velocity_at[b + 1] - first;
        double *U = self->U + layout->M_at[b];
        for (int i = 0; i < n; i++) U[layout->is_diagonal[b] ? i : i * (n + 1)] = self->unit[first + i] * self->unit[first + i];
    }
}

/* x <- x - U^2 C^T S^-1 (C x - rhs), with the rows that are not set aside; rhs NULL: zero. */
static void project(search *self, const zd_point *point, const double *rhs)
{
    double *y = self->weighted->blocks->x;
    const int n = point->system->nv;
    zd_weighted_times(self->weighted, point->terms.C, self->x, rhs, y);
    zd_blocks_solve(self->weighted->blocks, y);
    zd_clear(n, self->change);
    zd_row_groups_subtract(&self->weighted->row_groups, point->terms.C, NULL, y, self->change);
    for (int i = 0; i < n; i++) self->x[i] += self->unit[i] * self->unit[i] * self->change[i];
}

/* True if x satisfies the row: |row x - target| <= share (sum of its terms + other). */
static int is_satisfied(const zd_row_of_C *row, const double *x, double target, double share, double other)
{
    double sum = -target, size = fabs(target) + other;
    for (int j = 0; j < row->count; j++) {
        sum += row->x[j] * x[row->column[j]];
        size += fabs(row->x[j] * x[row->column[j]]);
    }
    return fabs(sum) <= share * size;
}

/* True if the projected random velocity satisfies the row. Where the constraints leave no freedom it is rounding error, and so is the
 * sum of a row's terms: the size of the row at the velocities before the projection counts, too. */
static int is_satisfied_by_velocity(const search *self, const zd_row_of_C *row)
{
    double reach = 0;
    for (int j = 0; j < row->count; j++) reach += fabs(row->x[j]) * self->unit[row->column[j]];
    return is_satisfied(row, self->x, 0, SATISFIED_BY_VELOCITY, ZERO_VELOCITY * reach);
}

/* Restores rows that the projected velocity violates; returns how many remain set aside. */
static int restore_violated(search *self, const zd_point *point, int *holonomic)
{
    int count = *holonomic = 0;
    for (int k = 0; k < zd_constraints(point->system); k++) {
        const zd_row_of_C row = zd_point_row(point, k);
        if (!is_satisfied_by_velocity(self, &row)) self->candidate[k] = 0;
        count += self->candidate[k];
        *holonomic += self->candidate[k] && k < point->system->mh;
    }
    return count;
}

/* Check that accelerations that satisfy the other rows satisfy those set aside at this velocity; else point->failed_index is the first
 * that is violated. */
static int agree(search *self, zd_point *point, const double *v, int *they_do)
{
    zd_point_move_velocity(point, v);
    int status = zd_point_need(point, ZD_XI);
    if (status) return status;
    zd_clear(point->system->nv, self->x);
    for (int i = 0; i < PROJECTIONS; i++) project(self, point, point->terms.xi);
    const double of_xi = zd_max_scaled(zd_constraints(point->system), point->terms.xi, point->inverse_size), largest = fmax(of_xi, ZERO_XI);
    *they_do = 1;
    for (int k = 0; k < zd_constraints(point->system) && *they_do; k++) {
        const zd_row_of_C row = zd_point_row(point, k);
        *they_do = !self->candidate[k] || is_satisfied(&row, self->x, point->terms.xi[k], SATISFIED_BY_ACCELERATION,
                                                            largest * point->size[k]);
        if (!*they_do) point->failed_index = k;
    }
    return ZD_DONE;
}

/* True if the projected random velocity is more than rounding error: some part of the system can move. */
static int can_move(const search *self, int n)
{
    for (int i = 0; i < n; i++)
        if (fabs(self->x[i]) > ZERO_VELOCITY * self->unit[i]) return 1;
    return 0;
}

/* Classifies the rows set aside, with the velocity at the start and a random one in self->x. */
static int classify(search *self, zd_point *point)
{
    const int n = point->system->nv;
    const double speed = 1 + zd_max_scaled(n, point->v, point->inverse_unit);
    const int has_velocity = can_move(self, n);
    int at_start = 1, at_any = 1;
    if (!(point->system->provides & ZD_XI)) return ZD_DONE;
    zd_copy_all(n, point->v, self->v0);
    for (int i = 0; i < n; i++) self->v[i] = self->v0[i] + speed * self->x[i];
    int status = agree(self, point, self->v0, &at_start);
    if (!status && at_start && has_velocity) status = agree(self, point, self->v, &at_any);
    zd_point_move_velocity(point, self->v0);
    return status ? status : !at_start ? ZD_CONTRADICTION : !at_any ? ZD_BIFURCATION : ZD_DONE;
}

static int note(search *self, zd_point *point)
{
    zd_rank *rank = point->rank;
    int holonomic, count = restore_violated(self, point, &holonomic);
    if (!count) return ZD_DONE;
    rank->left_out = zd_store_bytes(rank->store, zd_constraints(point->system));
    if (!rank->left_out) return ZD_NO_MEMORY;
    memcpy(rank->left_out, self->candidate, zd_constraints(point->system));
    rank->max_rank -= count;
    rank->max_rank_holonomic -= holonomic;
    return classify(self, point);
}

/* Sets rows with small pivots aside. If the dependent rows are the welds that join the parts of a split body, bodies are no longer
 * split. */
static int find_candidates(search *self, const zd_point *point, double little)
{
    for (;;) {
        const int is_complete = self->whole.max_touchers == INT_MAX;
        if (!self->weighted) self->weighted = zd_weighted_create(&self->store, &self->whole);
        if (!self->weighted) return ZD_NO_MEMORY;
        const int of_welds = zd_weighted_leave_out(self->weighted, point->terms.C, self->U, little, self->candidate);
        if (of_welds < 0) return ZD_NO_MEMORY;
        if (!of_welds || is_complete) return ZD_DONE;
        self->whole.max_touchers = INT_MAX;
        self->weighted = NULL;
    }
}

static void project_random(search *self, const zd_point *point)
{
    unsigned seed = 1;
    for (int i = 0; i < point->system->nv; i++) {
        seed = seed * 1664525u + 1013904223u;
        self->x[i] = self->unit[i] * ((double)(seed >> 8) * 0x1p-23 - 1);
    }
    for (int i = 0; i < PROJECTIONS; i++) project(self, point, NULL);
}

/* True if the projected velocity satisfies all rows, including those set aside. */
static int satisfies_all(const search *self, const zd_point *point)
{
    int does = 1;
    for (int k = 0; does && k < zd_constraints(point->system); k++) {
        const zd_row_of_C row = zd_point_row(point, k);
        does = is_satisfied_by_velocity(self, &row);
    }
    return does;
}

static int find(search *self, zd_point *point)
{
    set_metric(self, point);
    self->whole = *point->layout;
    for (size_t i = 0, is_found = 0; i < sizeof SMALL_PIVOTS / sizeof *SMALL_PIVOTS && !is_found; i++) {
        int any = 0, status = find_candidates(self, point, SMALL_PIVOTS[i]);
        if (status) return status;
        for (int k = 0; k < zd_constraints(point->system); k++) any |= self->candidate[k];
        if (!any) return ZD_DONE;
        project_random(self, point);
        is_found = satisfies_all(self, point);
    }
    return note(self, point);
}

int zd_redundancy_sparse_find(zd_point *point)
{
    zd_store store = {NULL};
    search *self = zd_store_create(&store, create, point->system);
    const int status = self ? find(self, point) : ZD_NO_MEMORY;
    if (self) zd_store_release(&self->store);
    zd_store_release(&store);
    return status;
}
