/* Minimum-norm steps of many bodies by block elimination, at a cost proportional to their number in chains, trees and rows of loops. */
#include <math.h>

#include "../../../linalg/small.h"
#include "problem.h"

static const double WISHED = 1e-6;      /* weight of a wish relative to the norm of a step */

typedef struct sparse {
    double *factor, *right;         /* (most,) of the equations */
    unsigned char *is_square;       /* (most,) */
    double *x;                      /* (n,) */
} sparse;

static void *create(zd_arena *arena, const zd_assembly *of)
{
    const sparse self = {
        .factor = zd_arena_doubles(arena, of->most), .right = zd_arena_doubles(arena, of->most),
        .is_square = zd_arena_bytes(arena, of->most), .x = zd_arena_doubles(arena, of->n),
    };
    return zd_arena_copy(arena, &self, sizeof self);
}

/* x <- solution of the first `rows` rows */
static void solve_equations(zd_assembly *self, int rows, const double *weight, double *x)
{
    const sparse *of = self->solver_data;
    const zd_sparse_equations equations = {
        .blocks = self->layout->blocks, .at = self->layout->velocity_at, .block_of = self->layout->block_of, .rows = rows,
        .row = self->J, .right = of->right, .factor = of->factor, .is_square = of->is_square, .weight = weight};
    const int status = zd_minimum_norm(&equations, x);
    if (status && !self->status) self->status = status;
}

static double weighted_length(const zd_assembly *self, int row, const double *weight)
{
    return zd_assembly_length_of(self, row) / zd_assembly_unit_of(self, row, weight);
}

/* x <- x + smallest change that leaves the required rows unchanged and brings wishes as near to `right` as that allows. It is computed
 * twice, as damping leaves a share of each wish after the first. */
static void approach_wished(zd_assembly *self, int first, const double *right, const double *weight, double *x)
{
    const sparse *of = self->solver_data;
    double longest = 0;
    for (int k = first; k < self->rows; k++) longest = fmax(longest, weighted_length(self, k, weight));
    if (!(longest > 0)) return;
    zd_clear(first, of->right);
    for (int times = 0; times < 2; times++) {
        for (int k = first; k < self->rows; k++) {
            of->is_square[k] = 1;
            of->factor[k] = 1 / (longest * WISHED);
            of->right[k] = right[k] - zd_assembly_row_times(self, k, x);
        }
        solve_equations(self, self->rows, weight, of->x);
        zd_add_scaled(self->n, x, 1, of->x);
    }
}

static void solve(zd_assembly *self, int required, const double *right, const double *weight, double *x)
{
    const sparse *of = self->solver_data;
    for (int k = 0; k < required; k++) {
        const double length = weighted_length(self, k, weight);
        of->is_square[k] = 0;
        of->factor[k] = length > 0 ? 1 / length : 1;
        of->right[k] = right[k];
    }
    solve_equations(self, required, weight, x);
    if (required < self->rows) approach_wished(self, required, right, weight, x);
}

static double prepare(zd_assembly *self)
{
    (void)self;
    return 1;       /* rows have a length of about one, and few touch a body */
}

static int damp(zd_assembly *self, double mu)
{
    const sparse *of = self->solver_data;
    for (int k = 0; k < self->rows; k++) {
        of->is_square[k] = 1;
        of->factor[k] = 1 / sqrt(mu);
        of->right[k] = -self->r[k];
    }
    solve_equations(self, self->rows, NULL, self->step);
    return 1;
}

const zd_assembly_solver zd_assembly_sparse = {create, solve, prepare, damp};
