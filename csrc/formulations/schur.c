/* (13): the multipliers from the m x m matrix C M^-1 C^T, and then the accelerations.
 *
 *     M = L L^T                       Cholesky; L is lower triangular
 *     C L^-T = G Q                    rows of Q orthonormal, G lower triangular
 *     C M^-1 C^T = G G^T
 *
 * G is the Cholesky factor of C M^-1 C^T, found by orthogonalizing the rows of C L^-T instead of multiplying them: so the
 * condition of the constraints enters once and not squared, for the same work. With y = L^-1 (f - d) and z = G^-1 xi, (13)
 * reads
 *
 *     lambda = G^-T (Q y - z),    vdot = L^-T (y - Q^T (Q y - z)),
 *
 * that is: what y has along the constraints is taken out and z put in its place. A correction, (27), has y = 0.
 */
#include "dependent.h"

#include "../linalg/small.h"

enum { DEPENDENT_BELOW = 1024 };    /* units of rounding left of a row after taking out the others: then it is one of them */

typedef struct schur {
    int n, m;
    double *L;      /* (n, n), reciprocals on the diagonal */
    double *Q;      /* (m, n) */
    double *G;      /* (m, m), reciprocals on the diagonal */
    double *b;      /* (m,) */
} schur;

static void *take(zd_arena *arena, const zd_system *system)
{
    size_t n = (size_t)system->nv, m = (size_t)zd_constraints(system);
    schur self = {
        .n = (int)n,
        .m = (int)m,
        .L = zd_take_doubles(arena, n * n),
        .Q = zd_take_doubles(arena, m * n),
        .G = zd_take_doubles(arena, m * m),
        .b = zd_take_doubles(arena, m),
    };
    return zd_take_filled(arena, &self, sizeof self);
}

/* Takes out of row k what it has along the rows before it; gives what is left, squared. */
ZD_INLINE double orthogonalize(const int n, int m, int k, double *Q, double *G)
{
    double *q = Q + k * n;
    for (int j = 0; j < k; j++) {
        double along = zd_dot(n, Q + j * n, q);
        G[k * m + j] += along;
        zd_add_scaled(n, q, -along, Q + j * n);
    }
    return zd_dot(n, q, q);
}

/* Returns m, or the row that depends on those before it. */
ZD_INLINE int factor_rows(const int n, int m, const double *C, const double *L, double *Q, double *G)
{
    for (int k = 0; k < m; k++) {
        double *q = Q + k * n;
        for (int i = 0; i < n; i++) q[i] = C[k * n + i];
        zd_forward(n, n, L, q);
        for (int j = 0; j < k; j++) G[k * m + j] = 0;
        double whole = zd_dot(n, q, q), rest = orthogonalize(n, m, k, Q, G);
        if (rest < 0.01 * whole) rest = orthogonalize(n, m, k, Q, G);       /* twice is enough */
        double least = DEPENDENT_BELOW * 0x1p-53;
        if (!(rest > least * least * whole) || !(rest < INFINITY)) return k;
        double inverse = 1 / sqrt(rest);
        G[k * m + k] = inverse;
        for (int i = 0; i < n; i++) q[i] *= inverse;
    }
    return m;
}

static int factor(void *memory, zd_point *point)
{
    schur *self = memory;
    int n = self->n, m = self->m;
    point->culprit = ZD_SIZED(zd_cholesky, n, point->terms.M, self->L);
    if (point->culprit < n) return ZD_NOT_DEFINITE;
    point->culprit = ZD_SIZED(factor_rows, n, m, point->terms.C, self->L, self->Q, self->G);
    return point->culprit < m ? ZD_DEPENDENT : ZD_DONE;
}

ZD_INLINE int solve_sized(const int n, schur *self, const double *force, const double *rhs, double *x, double *lambda)
{
    int m = self->m;
    double *b = self->b;
    for (int i = 0; i < n; i++) x[i] = force ? force[i] : 0;
    if (force) zd_forward(n, n, self->L, x);
    for (int k = 0; k < m; k++) b[k] = rhs[k];
    zd_forward(m, m, self->G, b);                               /* z */
    for (int k = 0; k < m; k++) {
        const double *q = self->Q + k * n;
        b[k] = (force ? zd_dot(n, q, x) : 0) - b[k];            /* Q y - z */
        zd_add_scaled(n, x, -b[k], q);
    }
    zd_backward(n, n, self->L, x);                              /* (13), (27) */
    if (!lambda) return 0;
    zd_backward(m, m, self->G, b);
    for (int k = 0; k < m; k++) lambda[k] = b[k];
    return 0;
}

static void solve(void *memory, const double *force, const double *rhs, double *x, double *lambda)
{
    schur *self = memory;
    (void)ZD_SIZED(solve_sized, self->n, self, force, rhs, x, lambda);
}

const zd_formulation zd_schur = {
    .card = {"schur", "Dependent variables; multipliers from the small matrix C M^-1 C^T, then accelerations.", "(13), (27)", 0},
    ZD_DEPENDENT_STATE,
    .take = take,
    .factor = factor,
    .solve = solve,
};
