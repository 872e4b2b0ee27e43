/* (9): the equations of motion along the free directions D, and the constraints, in one n x n matrix
 *
 *     H = [D^T M]         H vdot = [D^T (f - d); xi]
 *         [C    ]
 *
 * The multipliers follow from C^T lambda = f - d - M vdot: D^T of that is zero, so that [0; lambda] is what solves
 * H^T [.; lambda] = f - d - M vdot.
 */
#include <math.h>

#include "../linalg/dense.h"
#include "../linalg/small.h"
#include "../point/point.h"
#include "complement.h"
#include "formulation.h"
#include "sparse/structured.h"

typedef struct nullspace {
    zd_structured *many;    /* replaces all that follows for a declared structure with many constraints */
    zd_complement complement;
    double *memory;     /* (n, n): dense M, if the system's own is packed */
    const double *M;    /* (n, n): the point's */
    double *H;          /* (n, n): rows scaled, then factored */
    double *scale;      /* (n,): scales of the rows; powers of two */
    int *order;         /* (n,) */
    double *b;          /* (n,) */
} nullspace;

static void *create(zd_arena *arena, const zd_system *system, const void *given)
{
    (void)given;
    if (zd_rank_is_of_many(system)) {
        nullspace self = {.many = zd_structured_create(arena, system)};
        return zd_arena_copy(arena, &self, sizeof self);
    }
    size_t n = system->nv;
    double *H = zd_arena_doubles(arena, n * n);      /* made once D is known */
    nullspace self = {
        .complement = zd_complement_create(arena, system, H),
        .memory = zd_create_dense(arena, system, n * n),
        .H = H,
        .scale = zd_arena_doubles(arena, n),
        .order = zd_arena_ints(arena, n),
        .b = zd_arena_doubles(arena, n),
    };
    return zd_arena_copy(arena, &self, sizeof self);
}

/* Scales rows of different units, so that pivots are comparable. */
static void scale_row(int n, double *row, double *scale)
{
    int exponent = 0;
    double largest = zd_max_abs(n, row);
    if (largest > 0 && largest < INFINITY) (void)frexp(largest, &exponent);
    *scale = ldexp(1, -exponent);
    for (int i = 0; i < n; i++) row[i] *= *scale;
}

static void fill(nullspace *self, const double *M, const double *C)
{
    const zd_complement *complement = &self->complement;
    int n = complement->n, r = complement->r;
    for (int a = 0; a < r; a++)
        for (int j = 0; j < n; j++) {
            double sum = 0;
            for (int i = 0; i < n; i++) sum += complement->D[i * r + a] * M[i * n + j];
            self->H[a * n + j] = sum;
        }
    if (complement->m) zd_copy_all(complement->m * n, C, self->H + r * n);
    for (int i = 0; i < n; i++) scale_row(n, self->H + i * n, self->scale + i);
}

static int factor(void *memory, zd_point *point)
{
    nullspace *self = memory;
    if (self->many) return zd_structured_factor(self->many, point, 0);
    int n = self->complement.n;
    int status = zd_complement_review(&self->complement, point);
    if (status) return status;
    self->M = zd_dense_M(point, self->memory);
    fill(self, self->M, self->complement.C);                                      /* (9) */
    point->failed_index = zd_lu_factor(n, self->H, self->order);
    return point->failed_index < n ? ZD_SINGULAR : ZD_DONE;
}

static void solve(void *memory, const double *force, const double *rhs, double *x, double *lambda)
{
    nullspace *self = memory;
    int n = self->complement.n, m = self->complement.m, r = self->complement.r;
    if (self->many) {
        zd_structured_solve(self->many, force, rhs, x, lambda);
        return;
    }
    if (force) zd_complement_project(&self->complement, force, x);
    for (int a = 0; !force && a < r; a++) x[a] = 0;
    for (int k = 0; k < m; k++) x[r + k] = rhs[k];
    for (int i = 0; i < n; i++) x[i] *= self->scale[i];
    zd_lu_solve(n, self->H, self->order, x);                            /* (9), (26) */
    if (!lambda) return;
    double *b = self->b;
    for (int i = 0; i < n; i++) {
        b[i] = force ? force[i] : 0;
        for (int j = 0; j < n; j++) b[i] -= self->M[i * n + j] * x[j];
    }
    zd_lu_solve_transposed(n, self->H, self->order, b);
    for (int k = 0; k < m; k++) lambda[k] = self->scale[r + k] * b[r + k];
}

const zd_formulation zd_nullspace = {
    .card = {
        .name = "nullspace",
        .summary = "Dependent variables; equations along the free directions and constraints, in one matrix.",
        .equations = "(9), (26)",
        .description = "The equations of motion are projected on the free directions D of (14), and combined with the constraints "
                       "(6) in one matrix of the size of v. Multipliers are computed only if they are required. M may be singular "
                       "if the constraints leave no massless direction free.",
        .reference = "W. Blajer, A geometric unification of constrained system dynamics, Multibody System Dynamics 1 (1997) 3-21",
    },
    ZD_DEPENDENT_STATE,
    .many_constraints = ZD_MANY_CONSTRAINTS,
    .has_matrices_evaluated = 1,
    .create = create,
    .factor = factor,
    .solve = solve,
};
