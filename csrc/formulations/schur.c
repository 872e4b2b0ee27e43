/* (13): the multipliers from the m x m matrix C M^-1 C^T, and then the accelerations.
 *
 *     M = L D L^T                     Cholesky without square roots; L has ones on its diagonal
 *     C L^-T = G Q                    rows of Q orthogonal in the metric D^-1, G with ones on its diagonal
 *     C M^-1 C^T = G E G^T            E = Q D^-1 Q^T, diagonal
 *
 * G and E are the same factors of C M^-1 C^T, found by orthogonalizing the rows of C L^-T instead of multiplying them: so the
 * condition of the constraints enters once and not squared, for the same work. With y = L^-1 (f - d) and z = G^-1 xi, (13)
 * reads
 *
 *     mu = E^-1 (Q D^-1 y - z),    lambda = G^-T mu,    vdot = L^-T D^-1 (y - Q^T mu),
 *
 * that is: what y has along the constraints is taken out and z put in its place. A correction, (27), has y = 0.
 *
 * M^-1 enlarges the rounding of large reactions that meet in a light link. But C vdot = xi shows that error, and a correction by
 * what is left of it, (27b) again, removes it: so the digits do not depend on how far masses are apart.
 */
#include "dependent.h"

#include "../constraints/rows.h"
#include "../linalg/small.h"
#include "../point/matrices.h"
#include "coupling.h"

static const double ROUNDING = 8 * 0x1p-52;     /* of the terms of C x: nothing to be corrected */
static const double LEAST = 1024 * 0x1p-53;     /* of a row when others are taken out: what is left then is rounding */

typedef struct schur {
    int n, m;
    zd_coupling *coupling;      /* in place of what follows, where the structure is declared and all rows count; else NULL */
    int is_coupled;             /* whether that was factored */
    double *dense_C;    /* (m, n): where the system's own is packed */
    double *L;      /* (n, n), with D in reciprocals on the diagonal */
    double *Q;      /* (m, n) */
    double *G;      /* (m, m), with E in reciprocals on the diagonal */
    const double *C;    /* (m, n): the point's rows that count */
    double *b;      /* (m,) */
    double *rest, *correction;  /* (m,), (n,): what is left of C x = rhs, and what removes it */
} schur;

static void *take(zd_arena *arena, const zd_system *system, const void *given)
{
    (void)given;
    size_t n = (size_t)system->nv, m = (size_t)zd_constraints(system);
    schur self = {
        .n = (int)n,
        .m = (int)m,
        .coupling = zd_coupling_take(arena, system),
        .dense_C = zd_take_dense(arena, system, m * n),
        .L = zd_take_doubles(arena, n * n),
        .Q = zd_take_doubles(arena, m * n),
        .G = zd_take_doubles(arena, m * m),
        .b = zd_take_doubles(arena, m),
        .rest = zd_take_doubles(arena, m),
        .correction = zd_take_doubles(arena, n),
    };
    return zd_take_filled(arena, &self, sizeof self);
}

/* Takes out of q what it has along the first k rows of Q; how much that was goes to g, row k of G, or is added if it is done
 * again. Gives what is left of q, squared. */
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

static int is_left_of(double rest, double square) { return rest > LEAST * LEAST * square && rest < INFINITY; }

/* Returns m, or the row of which only rounding is left when those before it are taken out. */
ZD_INLINE int factor_all(const int n, const int m, const schur *self)
{
    const double *C = self->C;
    for (int k = 0; k < m; k++) {
        double *q = self->Q + k * n, *g = self->G + k * m;
        zd_forward(n, self->L, C + k * n, q);
        double square = zd_metric_dot(n, self->L, q, q), rest = orthogonalize(n, m, k, 0, self, q, g);
        if (rest < 0.01 * square) rest = orthogonalize(n, m, k, 1, self, q, g);    /* twice is enough */
        if (!is_left_of(rest, square)) return k;
        g[k] = 1 / rest;
    }
    return m;
}

/* Takes what they have along row k out of the rows behind it; how much that was goes to column k of G. */
static void take_out(const schur *self, int k)
{
    const int n = self->n, m = self->m;
    const double *q = self->Q + k * n, inverse = self->G[k * m + k];
    double *weighted = self->correction, dots[4];   /* D^-1 q */
    for (int i = 0; i < n; i++) weighted[i] = self->L[i * n + i] * q[i];
    for (int i = k + 1, rows; i < m; i += rows) {
        rows = i + 4 <= m ? 4 : 1;
        if (rows == 4) zd_four_dots(n, self->Q + i * n, n, weighted, dots);
        else dots[0] = zd_dot(n, weighted, self->Q + i * n);
        for (int r = i; r < i + rows; r++) {
            double along = self->G[r * m + k] = inverse * dots[r - i];
            zd_add_scaled(n, self->Q + r * n, -along, q);
        }
    }
}

/* The same of large systems, to the same bits: four rows at a time, each of which is ahead of what is taken out of it. */
static int factor_many(const schur *self)
{
    const int n = self->n, m = self->m;
    double *square = self->b;
    zd_forward_rows(n, m, self->L, self->C, self->Q);
    for (int k = 0; k < m; k++) square[k] = zd_metric_dot(n, self->L, self->Q + k * n, self->Q + k * n);
    for (int k = 0; k < m; k++) {
        double *q = self->Q + k * n, rest = k ? zd_metric_dot(n, self->L, q, q) : square[k];
        if (rest < 0.01 * square[k]) rest = orthogonalize(n, m, k, 1, self, q, self->G + k * m);
        if (!is_left_of(rest, square[k])) return k;
        self->G[k * m + k] = 1 / rest;
        take_out(self, k);
    }
    return m;
}

ZD_INLINE int factor_rows(const int n, const schur *self)
{
    if (n > ZD_UNROLLED) return factor_many(self);
    return ZD_ROWS(factor_all, n, self->m, self);
}

static int factor_packed(schur *self, zd_point *point)
{
    int status = zd_rows_find(point);
    self->is_coupled = !status && zd_rank_is_full(point);
    if (status || self->is_coupled) return status ? status : zd_coupling_factor(self->coupling, point);
    zd_dense_M(point, self->L);
    return ZD_DONE;
}

static int factor(void *memory, zd_point *point)
{
    schur *self = memory;
    int status = point->layout ? factor_packed(self, point) : ZD_DONE;
    if (status || self->is_coupled) return status;
    point->failed_index = ZD_SIZED(zd_cholesky, self->n, point->layout ? self->L : point->terms.M, self->L);
    if (point->failed_index < self->n) return ZD_NOT_DEFINITE;
    status = zd_rows_find(point);
    if (status) return status;
    self->m = point->rows;
    self->C = zd_dense_C(point, self->dense_C);
    point->failed_index = ZD_SIZED(factor_rows, self->n, self);
    return point->failed_index < self->m ? ZD_DEPENDENT_ROWS : ZD_DONE;
}

/* x <- L^-T D^-1 (y - Q^T mu), b <- E mu, where y = L^-1 force and b comes as z */
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

/* rest <- rhs - C x; returns whether it is more than the rounding of x makes it */
ZD_INLINE int is_any_left(const int n, const int m, const schur *self, const double *rhs, const double *x, double *rest)
{
    int left = 0;
    for (int k = 0; k < m; k++) {
        double sum = rhs[k], size = fabs(rhs[k]);
        for (int i = 0; i < n; i++) {
            double term = self->C[k * n + i] * x[i];
            sum -= term;
            size += fabs(term);
        }
        rest[k] = sum;
        left |= fabs(sum) > ROUNDING * size;
    }
    return left;
}

ZD_INLINE int is_left(const int n, const schur *self, const double *rhs, const double *x, double *rest)
{
    return ZD_ROWS(is_any_left, n, self->m, self, rhs, x, rest);
}

static void refine(const schur *self, const double *rhs, double *x)
{
    double *rest = self->rest;
    if (!ZD_SIZED(is_left, self->n, self, rhs, x, rest)) return;
    ZD_SIZED(zd_forward, self->m, self->G, rest, rest);
    ZD_SIZED(exchange, self->n, self, NULL, rest, self->correction);
    for (int i = 0; i < self->n; i++) x[i] += self->correction[i];
    for (int k = 0; k < self->m; k++) self->b[k] += rest[k];
}

static void solve(void *memory, const double *force, const double *rhs, double *x, double *lambda)
{
    schur *self = memory;
    if (self->is_coupled) {
        zd_coupling_solve(self->coupling, force, rhs, x, lambda);
        return;
    }
    ZD_SIZED(zd_forward, self->m, self->G, rhs, self->b);                   /* z */
    ZD_SIZED(exchange, self->n, self, force, self->b, x);
    if (force) refine(self, rhs, x);
    if (lambda) ZD_SIZED(zd_backward, self->m, self->G, self->b, lambda);
}

const zd_formulation zd_schur = {
    .card = {
        .name = "schur",
        .summary = "Dependent variables; multipliers from the small matrix C M^-1 C^T, then accelerations.",
        .equations = "(13), (27)",
        .description = "M is factored by Cholesky, then the small matrix C M^-1 C^T gives the multipliers, and these the "
                       "accelerations. It is usually the fastest, and the one that is taken where nothing else is asked for. M "
                       "has to be positive definite. Light parts beside heavy ones cost no digits, as an error of C vdot = xi is "
                       "seen and corrected.",
        .reference = "R. von Schwerin, MultiBody System SIMulation, Springer, 1999",
    },
    ZD_DEPENDENT_STATE,
    .inverts_mass = 1,
    .take = take,
    .factor = factor,
    .solve = solve,
};
