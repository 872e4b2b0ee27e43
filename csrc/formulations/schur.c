/* (13): the multipliers from the m x m matrix C M^-1 C^T, and then the accelerations.
 *
 *     M = L D L^T                     Cholesky without square roots; L has ones on its diagonal
 *     C L^-T = G Q                    rows of Q orthogonal in the metric D^-1, G with ones on its diagonal
 *     C M^-1 C^T = G E G^T            E = Q D^-1 Q^T, diagonal
 *
 * G and E are the same factors of C M^-1 C^T, found by orthogonalizing the rows of C L^-T instead of multiplying them: so the condition
 * of the constraints enters once and not squared, for the same work. With y = L^-1 (f - d) and z = G^-1 xi, (13) reads
 *
 *     mu = E^-1 (Q D^-1 y - z),    lambda = G^-T mu,    vdot = L^-T D^-1 (y - Q^T mu),
 *
 * that is: the components of y along the constraints are replaced by z. A correction, (27), has y = 0.
 *
 * M^-1 amplifies the rounding of large reactions on a light body. But C vdot = xi shows that error, and a correction by its residual,
 * (27b) again, removes it: so the accuracy does not depend on mass ratios.
 */
#include "formulation.h"

#include "../constraints/rank.h"
#include "../linalg/dense.h"
#include "../linalg/iteration.h"
#include "../linalg/small.h"
#include "../point/point.h"
#include "sparse/structured.h"

static const double MIN_REMAINDER = 1024 * 0x1p-53;     /* relative residual norm of a row that is rounding */
static const double SMALL_PIVOT = 0x1p-20;           /* pivot of C M^-1 C^T relative to its diagonal below which too many digits are lost */
static const double TURNED = 0.25;      /* bound of the squared sines by which Q turns: below, Q1 Q0^T + Q0 Q1^T is positive definite */

enum { MAX_SIZED = 8 };    /* velocities with kernels of their size: arms of seven joints and linkages of two loops have as many */

typedef struct schur {
    int n, m;
    int most;           /* number of rows allocated */
    zd_structured *many;        /* replaces all that follows for a declared structure with many constraints */
    zd_schur_blocks *blocks;      /* replaces what follows for a declared structure, unless limits replace constraints */
    int is_coupled;             /* 1: blocks were factored */
    double *dense_C;    /* (m, n): dense C, if the system's own is packed */
    double *L;      /* (n, n), with D in reciprocals on the diagonal */
    double *Q;      /* (m, n) */
    double *G;      /* (m, m), with E in reciprocals on the diagonal */
    const double *C;    /* (m, n): independent rows of C of the point */
    double *b;      /* (m,) */
    double *rows;   /* (4, n), for large systems: see linalg/dense.h */
    double *residual, *correction;  /* (m,), (n,): residual rhs - C x, and its correction */
} schur;

static void create_matrices(zd_arena *arena, schur *self)
{
    size_t n = self->n, m = self->most;
    self->L = zd_arena_doubles(arena, n * n);
    self->Q = zd_arena_doubles(arena, m * n);
    self->G = zd_arena_doubles(arena, m * m);
    self->b = zd_arena_doubles(arena, m);
    self->rows = n > MAX_SIZED ? zd_arena_doubles(arena, 4 * n > m ? 4 * n : m) : NULL;
    self->residual = n > MAX_SIZED ? self->rows : zd_arena_doubles(arena, m);   /* residual is for solves, rows for factorizations */
    self->correction = zd_arena_doubles(arena, n);
}

static void *create(zd_arena *arena, const zd_system *system, const void *given)
{
    (void)given;
    schur self = {.n = system->nv, .m = zd_constraints(system), .most = zd_constraints(system), .many = zd_structured_create(arena, system)};
    if (!zd_rank_is_of_many(system)) {
        self.blocks = zd_schur_blocks_create(arena, system);
        self.dense_C = zd_create_dense(arena, system, self.most * self.n);
        create_matrices(arena, &self);
    }
    return zd_arena_copy(arena, &self, sizeof self);
}

/* Projects the first k rows of Q out of q; the coefficients are written to g, row k of G, or added if this is repeated. Returns the
 * squared norm of the remaining q. */
ZD_INLINE double orthogonalize(const int n, const int m, int k, const int again, const schur *self, double *q, double *g)
{
    for (int j = 0; j < k; j++) {
        const double *other = self->Q + j * n;
        double along = self->G[j * m + j] * zd_metric_dot(n, self->L, other, q);
        g[j] = again ? g[j] + along : along;
        zd_add_scaled(n, q, -along, other);
    }
    return zd_metric_dot(n, self->L, q, q);
}

/* Factors; returns m, or the first row whose residual is rounding. */
ZD_INLINE int factor_all(const int n, const int m, const schur *self)
{
    const double *C = self->C;
    for (int k = 0; k < m; k++) {
        double *q = self->Q + k * n, *g = self->G + k * m;
        zd_forward(n, self->L, C + k * n, q);
        double square = zd_metric_dot(n, self->L, q, q), residual = orthogonalize(n, m, k, 0, self, q, g);
        if (residual < 0.01 * square) residual = orthogonalize(n, m, k, 1, self, q, g);    /* twice is enough */
        if (!(residual > MIN_REMAINDER * MIN_REMAINDER * square) || !(residual < INFINITY)) return k;
        g[k] = 1 / residual;
    }
    return m;
}

ZD_INLINE int factor_rows(const int n, const schur *self) { return ZD_ROWS(factor_all, n, self->m, self); }

/* ---- large systems, whose residual norms show independence ---- */

static int finds_independent(const zd_system *system)
{
    return system->structure != NULL || (system->nv > MAX_SIZED && zd_constraints(system) > ZD_FEW_CONSTRAINTS);
}

static zd_shares orthogonalize_all(schur *self, zd_point *point, int rows, const double *C)
{
    self->m = rows;
    self->C = C;
    const zd_orthogonal it = {self->n, rows, self->L, self->Q, self->G, self->b, self->rows, self->correction};
    zd_shares shares = zd_orthogonalize(&it, C, MIN_REMAINDER * MIN_REMAINDER);
    point->rank->was_turned |= !(shares.turned < TURNED);
    point->failed_index = shares.rows;
    return shares;
}

/* True if M^-1 is well conditioned enough to serve as a metric. */
static int has_metric(const schur *self, const double *M)
{
    int has = 1;
    for (int i = 0; i < self->n; i++) has &= 1 > ZD_MIN_PIVOT * M[i * self->n + i] * self->L[i * self->n + i];
    return has;
}

static int factor_large(schur *self, zd_point *point)
{
    const zd_rank *rank = point->rank;
    const int may_show_rank = !(point->known & ZD_RANKED) && rank->max_rank == rank->m && rank->m > ZD_FEW_CONSTRAINTS
                           && rank->m <= self->most && !point->layout;
    if (may_show_rank) {
        zd_shares shares = orthogonalize_all(self, point, rank->m, point->terms.C);
        const int is_conclusive = shares.rows == rank->m && shares.least > ZD_ILL_CONDITIONED * ZD_ILL_CONDITIONED;
        if (is_conclusive && has_metric(self, point->terms.M) && zd_rows_are_long(point)) zd_use_all_constraints(point);
    }
    const int failed_index = point->failed_index, is_known = may_show_rank && (point->known & ZD_RANKED), status = zd_find_independent(point);
    if (status || is_known) return status;
    if (may_show_rank && zd_rank_is_full(point)) point->failed_index = failed_index;
    else orthogonalize_all(self, point, point->rows, zd_dense_C(point, self->dense_C));
    return point->failed_index < self->m ? ZD_DEPENDENT_ROWS : ZD_DONE;
}

#define FACTOR_ROWS(n) static int factor_##n(const schur *self) { return factor_rows(n, self); }
FACTOR_ROWS(1) FACTOR_ROWS(2) FACTOR_ROWS(3) FACTOR_ROWS(4) FACTOR_ROWS(5) FACTOR_ROWS(6) FACTOR_ROWS(7) FACTOR_ROWS(8)
static int (*const FACTOR[])(const schur *self) = {factor_1, factor_1, factor_2, factor_3, factor_4, factor_5, factor_6, factor_7, factor_8};

static int factor_dense(schur *self, zd_point *point, const double *M)
{
    point->failed_index = ZD_SIZED(zd_cholesky, self->n, M, self->L);
    if (point->failed_index < self->n) return ZD_NOT_DEFINITE;
    if (self->n > MAX_SIZED) return factor_large(self, point);
    int status = zd_find_independent(point);
    if (status) return status;
    self->m = point->rows;
    self->C = zd_dense_C(point, self->dense_C);
    point->failed_index = FACTOR[self->n](self);
    return point->failed_index < self->m ? ZD_DEPENDENT_ROWS : ZD_DONE;
}

/* ---- systems that declare their structure ---- */

/* True if its pivots show that all constraints are independent, or that is known. */
static int are_independent(const schur *self, zd_point *point)
{
    if (point->known & ZD_RANKED) return 1;
    return self->blocks->share > ZD_ILL_CONDITIONED * ZD_ILL_CONDITIONED && zd_schur_blocks_has_long_rows(self->blocks, point);
}

/* The same with redundant constraints: their selection is known beforehand. */
static int factor_chosen(schur *self, zd_point *point)
{
    int status = zd_find_independent(point);
    self->is_coupled = 0;
    if (status || !self->blocks || point->rank->lost || zd_rank_is_full(point)) return status;
    status = zd_schur_blocks_factor(self->blocks, point);
    self->is_coupled = !status && self->blocks->share > SMALL_PIVOT;
    return status == ZD_DEPENDENT_ROWS ? ZD_DONE : status;
}

/* Factors C M^-1 C^T in blocks, if all constraints are independent and it keeps enough digits. */
static int factor_coupled(schur *self, zd_point *point)
{
    const zd_rank *rank = point->rank;
    int status = ZD_DEPENDENT_ROWS;
    if (rank->max_rank < rank->m) return factor_chosen(self, point);
    if (self->blocks && rank->max_rank == rank->m && rank->m <= rank->n && !(point->known & ZD_RANKED && !zd_rank_is_full(point)))
        status = zd_schur_blocks_factor(self->blocks, point);
    if (status && status != ZD_DEPENDENT_ROWS) return status;
    self->is_coupled = !status && self->blocks->share > SMALL_PIVOT;
    if (self->is_coupled && are_independent(self, point)) zd_use_all_constraints(point);
    status = zd_find_independent(point);
    if (!status) self->is_coupled &= zd_rank_is_full(point);
    return status;
}

/* Factors by blocks; or by dense matrices, if constraints are left out or C M^-1 C^T has lost too many digits. */
static int factor_packed(schur *self, zd_point *point)
{
    int status = factor_coupled(self, point);
    if (status || self->is_coupled) return status;
    return factor_dense(self, point, zd_dense_M(point, self->L));
}

static int factor_few(schur *self, zd_point *point)
{
    return point->layout ? factor_packed(self, point) : factor_dense(self, point, point->terms.M);
}

/* Factors; if a selection kept from an earlier point, which was good in the plain metric, is not in that of M^-1, it is made anew. */
static int factor(void *memory, zd_point *point)
{
    schur *self = memory;
    if (self->many) return zd_structured_factor(self->many, point, 1);
    const int status = factor_few(self, point);
    return status == ZD_DEPENDENT_ROWS && zd_discard_selection(point) ? factor_few(self, point) : status;
}

/* x <- L^-T D^-1 (y - Q^T mu), b <- E mu, where y = L^-1 force and b holds z */
ZD_INLINE void exchange_all(const int n, const int m, const schur *self, const double *force, double *b, double *x)
{
    if (force) zd_forward(n, self->L, force, x);                            /* y */
    else
        for (int i = 0; i < n; i++) x[i] = 0;
    for (int k = 0; k < m; k++) {
        const double *q = self->Q + k * n;
        b[k] = (force ? zd_metric_dot(n, self->L, q, x) : 0) - b[k];
        zd_add_scaled(n, x, -self->G[k * m + k] * b[k], q);
    }
    zd_backward(n, self->L, x, x);                                          /* (13), (27) */
}

ZD_INLINE void exchange(const int n, const schur *self, const double *force, double *b, double *x)
{
    ZD_ROWS(exchange_all, n, self->m, self, force, b, x);
}

/* residual <- rhs - C x; returns 1 if it exceeds the rounding of x */
ZD_INLINE int is_any_significant(const int n, const int m, const schur *self, const double *rhs, const double *x, double *residual)
{
    int left = 0;
    for (int k = 0; k < m; k++) {
        double sum = rhs[k], size = fabs(rhs[k]);
        for (int i = 0; i < n; i++) {
            double term = self->C[k * n + i] * x[i];
            sum -= term;
            size += fabs(term);
        }
        residual[k] = sum;
        left |= fabs(sum) > ZD_RESIDUAL_ROUNDING * size;
    }
    return left;
}

ZD_INLINE int is_residual_significant(const int n, const schur *self, const double *rhs, const double *x, double *residual)
{
    return ZD_ROWS(is_any_significant, n, self->m, self, rhs, x, residual);
}

static void refine(const schur *self, const double *rhs, double *x)
{
    double *residual = self->residual;
    if (!ZD_SIZED(is_residual_significant, self->n, self, rhs, x, residual)) return;
    ZD_SIZED(zd_forward, self->m, self->G, residual, residual);
    ZD_SIZED(exchange, self->n, self, NULL, residual, self->correction);
    for (int i = 0; i < self->n; i++) x[i] += self->correction[i];
    for (int k = 0; k < self->m; k++) self->b[k] += residual[k];
}

static void solve_dense(schur *self, const double *force, const double *rhs, double *x, double *lambda)
{
    ZD_SIZED(zd_forward, self->m, self->G, rhs, self->b);                   /* z */
    ZD_SIZED(exchange, self->n, self, force, self->b, x);
    if (force) refine(self, rhs, x);
    if (lambda) ZD_SIZED(zd_backward, self->m, self->G, self->b, lambda);
}

static void solve(void *memory, const double *force, const double *rhs, double *x, double *lambda)
{
    schur *self = memory;
    if (self->many) zd_structured_solve(self->many, force, rhs, x, lambda);
    else if (self->is_coupled) zd_schur_blocks_solve(self->blocks, force, rhs, x, lambda);
    else solve_dense(self, force, rhs, x, lambda);
}

const zd_formulation zd_schur = {
    .card = {
        .name = "schur",
        .summary = "Dependent variables; multipliers from the small matrix C M^-1 C^T, then accelerations.",
        .equations = "(13), (27)",
        .description = "M is factored by Cholesky, then the small matrix C M^-1 C^T yields the multipliers, and these the "
                       "accelerations. It is usually the fastest, and the default. M "
                       "must be positive definite. Large mass ratios cost no digits, as an error of C vdot = xi is "
                       "detected and corrected.",
        .reference = "R. von Schwerin, MultiBody System SIMulation, Springer, 1999",
    },
    ZD_DEPENDENT_STATE,
    .inverts_mass = 1,
    .many_constraints = ZD_MANY_CONSTRAINTS,
    .has_matrices_evaluated = 1,
    .create = create,
    .finds_independent = finds_independent,
    .factor = factor,
    .solve = solve,
};
