/* (8): accelerations and multipliers together from the (n + m) x (n + m) matrix
 *
 *     G = [M  C^T]        G [vdot; lambda] = [f - d; xi]
 *         [C   0 ]
 *
 * by Gaussian elimination with partial pivoting if it is small, else by Bunch and Kaufman's symmetric factorization with rook pivoting
 * in half the memory. Both require only that G is regular. M and the rows of C have different units; each row is first scaled to the
 * size of M, and its multiplier back afterwards, so that pivots are comparable.
 */
#include "formulation.h"

#include <math.h>
#include <string.h>

#include "../constraints/rank.h"
#include "../linalg/dense.h"
#include "../linalg/small.h"
#include "../point/point.h"
#include "sparse/structured.h"

typedef struct augmented {
    int n, m;
    zd_structured *many;    /* replaces all that follows for a declared structure with many constraints */
    double *M, *C;      /* (n, n), (m, n): dense M and C, if the system's own are packed */
    double *scale;      /* (m,): scales of the rows of C in G */
    int is_small;       /* 1: all of G is stored */
    double *G;          /* (n + m, n + m), or its upper triangle, row after row */
    double *b;          /* (n + m,) */
    int *order;         /* (n + m,) */
} augmented;

static void *create_dense(zd_arena *arena, const zd_system *system, const void *given)
{
    (void)given;
    size_t n = system->nv, m = zd_constraints(system), size = n + m;
    const int is_small = size <= ZD_UNROLLED;
    augmented self = {
        .n = (int)n,
        .m = (int)m,
        .M = zd_create_dense(arena, system, n * n),
        .C = zd_create_dense(arena, system, m * n),
        .scale = zd_arena_doubles(arena, m),
        .is_small = is_small,
        .G = zd_arena_doubles(arena, is_small ? size * size : zd_triangle(size)),
        .b = zd_arena_doubles(arena, size),
        .order = zd_arena_ints(arena, size),
    };
    return zd_arena_copy(arena, &self, sizeof self);
}

static void *create(zd_arena *arena, const zd_system *system, const void *given)
{
    if (!zd_rank_is_of_many(system)) return create_dense(arena, system, given);
    augmented self = {.many = zd_structured_create(arena, system)};
    return zd_arena_copy(arena, &self, sizeof self);
}

/* Sets the scales to powers of two, so that scaling is exact. */
static void set_scales(augmented *self, const double *M, const double *C)
{
    int n = self->n;
    double mass = zd_power_below(zd_max_abs(n * n, M));
    for (int k = 0; k < self->m; k++) {
        double row = zd_power_below(zd_max_abs(n, C + k * n));
        self->scale[k] = mass > 0 && row > 0 && mass < INFINITY && row < INFINITY ? mass / row : 1;
    }
}

static void fill(augmented *self, const double *M, const double *C)
{
    int n = self->n, size = n + self->m;
    double *G = self->G;
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++) G[i * size + j] = M[i * n + j];
    for (int k = 0; k < self->m; k++) {
        for (int j = 0; j < n; j++) G[(n + k) * size + j] = G[j * size + n + k] = self->scale[k] * C[k * n + j];
        for (int l = 0; l < self->m; l++) G[(n + k) * size + n + l] = 0;
    }
}

static void fill_triangle(augmented *self, const double *M, const double *C)
{
    int n = self->n, m = self->m, size = n + m;
    for (int i = 0; i < n; i++) {
        double *row = zd_triangle_row(size, self->G, i);
        for (int j = i; j < n; j++) row[j] = M[i * n + j];
        for (int k = 0; k < m; k++) row[n + k] = self->scale[k] * C[k * n + i];
    }
    memset(zd_triangle_row(size, self->G, n) + n, 0, zd_triangle(m) * sizeof *self->G);
}

/* Factors G; returns n + m, or the column that is linearly dependent. */
static int factor_filled(augmented *self)
{
    int size = self->n + self->m;
    if (self->is_small) return zd_lu_factor(size, self->G, self->order);
    int step = zd_symmetric_factor(size, self->G, self->order);
    return step == size ? size : zd_symmetric_dependent(size, self->G, self->order, step, self->b);
}

static int factor(void *memory, zd_point *point)
{
    augmented *self = memory;
    if (self->many) return zd_structured_factor(self->many, point, 0);
    int status = zd_find_independent(point), size = self->n + point->rows;
    if (status) return status;
    self->m = point->rows;
    const double *M = zd_dense_M(point, self->M), *C = zd_dense_C(point, self->C);
    set_scales(self, M, C);
    if (self->is_small) fill(self, M, C);                               /* (8) */
    else fill_triangle(self, M, C);
    int column = factor_filled(self);
    if (column == size) return ZD_DONE;
    point->failed_index = column < self->n ? column : column - self->n;
    return column < self->n ? ZD_SINGULAR : ZD_DEPENDENT_ROWS;
}

static void solve(void *memory, const double *force, const double *rhs, double *x, double *lambda)
{
    augmented *self = memory;
    int n = self->n, m = self->m;
    double *b = self->b;
    if (self->many) {
        zd_structured_solve(self->many, force, rhs, x, lambda);
        return;
    }
    for (int i = 0; i < n; i++) b[i] = force ? force[i] : 0;
    for (int k = 0; k < m; k++) b[n + k] = self->scale[k] * rhs[k];
    if (self->is_small) zd_lu_solve(n + m, self->G, self->order, b);    /* (8), (25) */
    else zd_symmetric_solve(n + m, self->G, self->order, b);
    zd_copy_all(n, b, x);
    if (!lambda) return;
    for (int k = 0; k < m; k++) lambda[k] = self->scale[k] * b[n + k];
}

const zd_formulation zd_augmented = {
    .card = {
        .name = "augmented",
        .summary = "Dependent variables; accelerations and multipliers together, from one symmetric matrix.",
        .equations = "(8), (25)",
        .description = "Accelerations and multipliers are solved together from one symmetric matrix of M, C and its transpose, "
                       "which is factored with pivoting. M may be singular if the constraints leave no massless direction "
                       "free, so that systems may have massless parts. Positions and velocities both drift from their "
                       "constraints and are corrected with the same matrix.",
        .reference = "E. J. Haug, Computer Aided Kinematics and Dynamics of Mechanical Systems, Allyn and Bacon, 1989",
    },
    ZD_DEPENDENT_STATE,
    .many_constraints = ZD_MANY_CONSTRAINTS,
    .has_matrices_evaluated = 1,
    .create = create,
    .factor = factor,
    .solve = solve,
};

/* For motions whose own formulation does not support structures with many constraints. */
const zd_formulation zd_augmented_dense = {
    ZD_DEPENDENT_STATE,
    .create = create_dense,
    .factor = factor,
    .solve = solve,
};
