/* Minimum-norm steps by a complete orthogonal decomposition of dense rows, damped ones by Cholesky's factors of their products. */
#include <math.h>

#include "../../../linalg/dense.h"
#include "../../../linalg/small.h"
#include "problem.h"

static const double RANK = 1e-9;                /* relative to the longest row: bound below which rows are redundant */
enum { POWERS = 200 };

typedef struct dense {
    zd_row_space required, wished;
    double *square, *factors;                   /* (k, k), (k, k + 2) with the smaller k of rows and velocities */
} dense;

static void *create(zd_arena *arena, const zd_assembly *of)
{
    const size_t fewer = of->most < of->n ? of->most : of->n;
    const dense self = {
        .required = zd_row_space_create(arena, of->most, of->n), .wished = zd_row_space_create(arena, of->given->targets, of->n),
        .square = zd_arena_doubles(arena, fewer * fewer), .factors = zd_arena_doubles(arena, fewer * fewer + 2 * fewer),
    };
    return zd_arena_copy(arena, &self, sizeof self);
}

/* ---- minimum norm ---- */

/* Rows of J from `first` on, by weights; `keeps`: with their lengths, as otherwise rows of light bodies would be so long that those of heavy
 * ones seem redundant */
static void weigh_rows(zd_assembly *self, int first, int count, const double *weight, int keeps, double *A, double *right)
{
    const int n = self->n;
    for (int k = 0; k < count; k++, A += n) {
        const double *row = self->J[first + k].x, unit = keeps ? zd_assembly_unit_of(self, first + k, weight) : 1;
        for (int i = 0; i < n; i++) A[i] = weight ? row[i] / weight[i] * unit : row[i] * unit;
        right[k] *= unit;
    }
}

/* x <- x + the step along the null space of the required rows on which the wished rows come nearest to `right` */
static void approach_wished(zd_assembly *self, int first, const double *weight, double *right, double *x)
{
    dense *of = self->solver_data;
    const int n = self->n, count = self->rows - first, rank = of->required.rank;
    double *A = of->wished.A, square = 0;
    weigh_rows(self, first, count, weight, 0, A, right);
    for (int k = 0; k < count; k++) {
        right[k] -= zd_dot(n, A + k * n, x);
        square += zd_dot(n, A + k * n, A + k * n);
        zd_row_space_turn(&of->required, A + k * n);
    }
    of->wished.n = n - rank;
    for (int k = 0; k < count; k++)
        for (int i = 0; i < n - rank; i++) A[k * (n - rank) + i] = A[k * n + rank + i];
    zd_row_space_factor(&of->wished, count, 0, RANK * sqrt(square * (n - rank)));
    double *y = self->moved;
    zd_clear(rank, y);
    zd_row_space_solve(&of->wished, right, y + rank);
    zd_row_space_turn_back(&of->required, y);
    zd_add_scaled(n, x, 1, y);
}

static void solve(zd_assembly *self, int required, const double *right, const double *weight, double *x)
{
    dense *of = self->solver_data;
    zd_copy(self->rows, right, self->right);
    weigh_rows(self, 0, required, weight, 1, of->required.A, self->right);
    zd_row_space_factor(&of->required, required, RANK, 0);
    zd_row_space_solve(&of->required, self->right, x);
    if (required < self->rows) approach_wished(self, required, weight, self->right + required, x);
    for (int i = 0; weight && i < self->n; i++) x[i] /= weight[i];
}

/* ---- damped ---- */

static int fewer(const zd_assembly *self) { return self->rows < self->n ? self->rows : self->n; }

/* The product of J with its transpose, or of its transpose with it, whichever has fewer rows; returns its largest eigenvalue, at least 1. */
static double square_rows(zd_assembly *self)
{
    const dense *of = self->solver_data;
    const int m = self->rows, n = self->n, k = fewer(self);
    double *S = of->square, *x = of->factors + k * k, *y = x + k, largest = 0;
    zd_clear(k * k, S);
    for (int i = 0; k == m && i < m; i++)
        for (int j = 0; j <= i; j++) S[i * k + j] = S[j * k + i] = zd_dot(n, self->J[i].x, self->J[j].x);
    for (int i = 0; k < m && i < m; i++)
        for (int j = 0; j < n; j++) zd_add_scaled(n, S + j * k, self->J[i].x[j], self->J[i].x);
    for (int i = 0; i < k; i++) x[i] = 1 + 1.0 / (i + 2);       /* a vector that is orthogonal to none of interest */
    for (int i = 0; i < POWERS; i++) {
        for (int j = 0; j < k; j++) y[j] = zd_dot(k, S + j * k, x);
        largest = sqrt(zd_dot(k, y, y));
        for (int j = 0; j < k; j++) x[j] = largest > 0 ? y[j] / largest : 0;
    }
    return fmax(largest, 1);
}

static int damped_step(zd_assembly *self, double mu)
{
    const dense *of = self->solver_data;
    const int m = self->rows, n = self->n, k = fewer(self);
    double *A = of->factors, *y = A + k * k, *x = self->step;
    zd_copy_all(k * k, of->square, A);
    for (int i = 0; i < k; i++) A[i * k + i] += mu;
    if (zd_cholesky(k, A, A) < k) return 0;
    zd_clear(n, x);
    if (k == m) {
        zd_forward(m, A, self->r, y);
        zd_backward(m, A, y, y);
    }
    for (int i = 0; i < m; i++) zd_add_scaled(n, x, k == m ? -y[i] : -self->r[i], self->J[i].x);
    if (k < m) {
        zd_forward(n, A, x, x);
        zd_backward(n, A, x, x);
    }
    return 1;
}

const zd_assembly_solver zd_assembly_dense = {create, solve, square_rows, damped_step};
