/* (13) without dense matrices but one, the coupling of the rows:
 *
 *     M_b = L D L^T                           each block by itself
 *     Y = C L^-T                              has entries where C has
 *     S = C M^-1 C^T = Y D^-1 Y^T             rows of two groups are coupled by the blocks that both touch
 *     S lambda = Y D^-1 y - xi,   vdot = L^-T D^-1 (y - Y^T lambda),   y = L^-1 (f - d)
 *
 * S has the condition of the constraints squared, which the orthogonalization in schur.c avoids. But C vdot = xi shows what that has cost,
 * and is corrected with the same factors until nothing is left of it: with the smallest pivots that are allowed, each time leaves a
 * thousandth or so. Where pivots are smaller, as masses are far apart, schur.c orthogonalizes after all.
 */
#include "coupling.h"

#include <string.h>

#include "../linalg/small.h"
#include "../point/gram.h"
#include "../point/mass.h"
#include "../point/matrices.h"

enum { MAX_REFINEMENTS = 4 };
static const double SMALL = 0x1p-36;           /* of the diagonal of S: a smaller pivot has lost too many digits */
static const double ROUNDING = 8 * 0x1p-52;     /* of the terms of C x: nothing to be corrected */

zd_coupling *zd_coupling_take(zd_arena *arena, const zd_system *system)
{
    const zd_structure *structure = system->structure;
    int rows = 0;
    for (int g = 0; structure && g < structure->groups; g++) rows += structure->rows[g];
    if (!structure || rows != zd_constraints(system)) return NULL;
    size_t n = (size_t)system->nv, m = (size_t)zd_constraints(system);
    zd_coupling self = {
        .n = (int)n,
        .m = (int)m,
        .L = zd_take_doubles(arena, (size_t)zd_size_of_M(system)),
        .D = zd_take_doubles(arena, n),
        .Y = zd_take_doubles(arena, (size_t)zd_size_of_C(system)),
        .S = zd_take_doubles(arena, m * m),
        .y = zd_take_doubles(arena, n),
        .z = zd_take_doubles(arena, n),
        .lambda = zd_take_doubles(arena, m),
        .rest = zd_take_doubles(arena, m),
        .step = zd_take_doubles(arena, m),
    };
    return zd_take_filled(arena, &self, sizeof self);
}

/* ---- factors ---- */

static int block_size(const zd_layout *layout, int b) { return layout->velocity_at[b + 1] - layout->velocity_at[b]; }

static void keep_diagonal(zd_coupling *self)
{
    const zd_layout *layout = self->layout;
    for (int b = 0; b < layout->blocks; b++) {
        int n = block_size(layout, b);
        for (int i = 0; i < n; i++)
            self->D[layout->velocity_at[b] + i] = self->L[layout->M_at[b] + (layout->is_diagonal[b] ? i : i * (n + 1))];
    }
}

/* Y <- C L^-T, in the columns of one block that a group touches */
static void transform(zd_coupling *self, int b, int toucher)
{
    const zd_layout *layout = self->layout;
    const int g = layout->toucher[toucher], n = block_size(layout, b), width = layout->width[g];
    const int at = layout->C_at[g] + layout->toucher_offset[toucher];
    const double *c = self->C + at, *L = self->L + layout->M_at[b];
    double *y = self->Y + at;
    for (int k = layout->row_at[g]; k < layout->row_at[g + 1]; k++, c += width, y += width)
        if (layout->is_diagonal[b]) ZD_SIZED(zd_copy, n, c, y);
        else ZD_SIZED(zd_forward, n, L, c, y);
}

int zd_coupling_factor(zd_coupling *self, zd_point *point)
{
    const zd_layout *layout = self->layout = point->layout;
    self->C = point->terms.C;
    point->failed_index = zd_mass_factor(point, self->L);
    if (point->failed_index < self->n) return ZD_NOT_DEFINITE;
    keep_diagonal(self);
    for (int b = 0; b < layout->blocks; b++)
        for (int i = layout->toucher_at[b]; i < layout->toucher_at[b + 1]; i++) transform(self, b, i);
    zd_gram(layout, self->Y, self->D, self->S);
    double *diagonal = self->rest;
    for (int k = 0; k < self->m; k++) diagonal[k] = self->S[k * (self->m + 1)];
    int factored = ZD_SIZED(zd_cholesky, self->m, self->S, self->S);
    for (int k = factored; k-- > 0;)
        if (!(1 > SMALL * diagonal[k] * self->S[k * (self->m + 1)])) factored = k;
    point->failed_index = factored;
    return factored < self->m ? ZD_DEPENDENT_ROWS : ZD_DONE;
}

/* ---- solution ---- */

/* y <- L^-1 force */
static void forward(const zd_coupling *self, const double *force, double *y)
{
    const zd_layout *layout = self->layout;
    for (int b = 0; b < layout->blocks; b++) {
        int n = block_size(layout, b), first = layout->velocity_at[b];
        if (layout->is_diagonal[b]) zd_copy(n, force + first, y + first);
        else ZD_SIZED(zd_forward, n, self->L + layout->M_at[b], force + first, y + first);
    }
}

/* x <- L^-T D^-1 y */
static void backward(const zd_coupling *self, const double *y, double *x)
{
    const zd_layout *layout = self->layout;
    for (int b = 0; b < layout->blocks; b++) {
        int n = block_size(layout, b), first = layout->velocity_at[b];
        if (!layout->is_diagonal[b]) ZD_SIZED(zd_backward, n, self->L + layout->M_at[b], y + first, x + first);
        for (int i = first; layout->is_diagonal[b] && i < first + n; i++) x[i] = self->D[i] * y[i];
    }
}

/* lambda <- S^-1 lambda, y <- y - Y^T lambda */
static void exchange(const zd_coupling *self, double *lambda, double *y)
{
    ZD_SIZED(zd_forward, self->m, self->S, lambda, lambda);
    ZD_SIZED(zd_backward, self->m, self->S, lambda, lambda);
    for (int k = 0; k < self->m; k++) {
        zd_row_of_C row = zd_packed_row(self->layout, self->Y, k);
        for (int j = 0; j < row.count; j++) y[row.column[j]] -= lambda[k] * row.x[j];
    }
}

/* rest <- rhs - C x; returns whether it is more than the rounding of x makes it */
static int is_left(const zd_coupling *self, const double *rhs, const double *x, double *rest)
{
    int left = 0;
    for (int k = 0; k < self->m; k++) {
        zd_row_of_C row = zd_packed_row(self->layout, self->C, k);
        double sum = rhs[k], size = fabs(rhs[k]);
        for (int j = 0; j < row.count; j++) {
            double term = row.x[j] * x[row.column[j]];
            sum -= term;
            size += fabs(term);
        }
        rest[k] = sum;
        left |= fabs(sum) > ROUNDING * size;
    }
    return left;
}

static void refine(zd_coupling *self, const double *rhs, double *x)
{
    for (int i = 0; i < MAX_REFINEMENTS && is_left(self, rhs, x, self->rest); i++) {
        memset(self->y, 0, (size_t)self->n * sizeof(double));
        for (int k = 0; k < self->m; k++) self->step[k] = -self->rest[k];
        exchange(self, self->step, self->y);
        backward(self, self->y, self->z);
        for (int j = 0; j < self->n; j++) x[j] += self->z[j];
        for (int k = 0; k < self->m; k++) self->lambda[k] += self->step[k];
    }
}

void zd_coupling_solve(zd_coupling *self, const double *force, const double *rhs, double *x, double *lambda)
{
    double *y = self->y, *z = self->z;
    if (force) forward(self, force, y);
    else memset(y, 0, (size_t)self->n * sizeof *y);
    for (int i = 0; i < self->n; i++) z[i] = self->D[i] * y[i];
    for (int k = 0; k < self->m; k++) {
        zd_row_of_C row = zd_packed_row(self->layout, self->Y, k);
        self->lambda[k] = (force ? zd_row_times(&row, z) : 0) - rhs[k];
    }
    exchange(self, self->lambda, y);
    backward(self, y, x);                                               /* (13), (27) */
    refine(self, rhs, x);
    if (lambda) memcpy(lambda, self->lambda, (size_t)self->m * sizeof *lambda);
}
