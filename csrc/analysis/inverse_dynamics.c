/* Efforts of a given motion: part of zerodrift.h.
 *
 * With Z (r, nv) a basis of the velocities that the constraints allow, orthonormal in characteristic scales, and V = D^-1/2 L^-1 Z, where
 * Z M Z^T = L D L^T, one that is orthonormal in the metric of M, the equations of motion (2) are projected onto V and solved for the
 * efforts u along the rows G (j, nv); what remains gives the multipliers:
 *
 *     V G^T u = V w,    w = M vdot + d - f,    C^T lambda = G^T u - w
 *
 * The norm of the residual V (w - G^T u) is that of the missing force in the metric of M.
 */
#include <math.h>
#include <string.h>

#include "../linalg/dense.h"
#include "../linalg/small.h"
#include "../point/point.h"

static const double VIOLATION = 1e-6;   /* relative to the size: larger violations of the constraints by the motion are an error */
static const double DEPENDENT = 1e-9;   /* share of a row, or of what an effort does elsewhere, that is rounding */
static const double MASSLESS = 1e-13;   /* relative to the largest: mass of a motion that counts as none */

typedef struct inverse {
    const zd_given_motion *given;
    zd_point *point;
    int n, m, freedoms;
    zd_row_space rows;      /* C in scaled velocities, each row divided by its length */
    double *length;         /* (m,): these lengths; 0: the row is the rounding error of terms that cancel */
    double *Z, *L;          /* (r, nv), (r, r): see above, factors by zd_cholesky(); Z of a system without constraints is not set */
    double mobility;        /* the largest entry of D^-1 */
    zd_row_space acting;    /* V G^T, weighted: a column for each effort */
    double *projected;      /* (efforts + 1, r): L^-1 Z of the rows of G and of w */
    double *wanted, *right; /* (nv,): w, and G^T u - w */
    double *x, *across;     /* (nv,) temporary */
    zd_row_space redundant; /* C^T in scaled velocities, where constraints are redundant, with columns divided by sizes */
    double *size;           /* (m,): these sizes, square roots of the diagonal of C M^-1 C^T; where M is singular, lengths */
} inverse;

static void *create(zd_arena *arena, const void *of)
{
    const zd_given_motion *given = of;
    const zd_system *system = given->system;
    const int n = system->nv, m = zd_constraints(system), count = given->efforts;
    const size_t nv = (size_t)n;
    const inverse self = {
        .given = given, .point = zd_point_create(arena, system, zd_arena_bytes(arena, sizeof(zd_statistics))), .n = n, .m = m,
        .rows = zd_row_space_create(arena, m, n), .length = zd_arena_doubles(arena, (size_t)m),
        .Z = zd_arena_doubles(arena, nv * nv), .L = zd_arena_doubles(arena, nv * nv),
        .acting = zd_row_space_create(arena, n, count), .projected = zd_arena_doubles(arena, nv * (size_t)(count + 1)),
        .wanted = zd_arena_doubles(arena, nv), .right = zd_arena_doubles(arena, nv), .across = zd_arena_doubles(arena, nv),
        .x = zd_arena_doubles(arena, nv), .redundant = zd_row_space_create(arena, n, m), .size = zd_arena_doubles(arena, (size_t)m),
    };
    return zd_arena_copy(arena, &self, sizeof self);
}

/* True if the motion violates the constraints (3), (5) or (6) */
static int is_violated(const inverse *self, const double *vdot)
{
    const zd_point *point = self->point;
    const zd_terms *terms = &point->terms;
    if (!self->m) return 0;
    const double *scale = self->given->inverse_scale, length = self->given->length;
    const double speed = length * (1 + zd_largest_scaled(self->n, point->v, scale));
    const double size = length * (1 + zd_largest_scaled(self->n, vdot, scale)) + speed * speed / length;
    for (int k = 0; k < self->m; k++) {
        const zd_row_of_C row = zd_point_row(point, k);
        const double Psi = zd_row_times(&row, point->v) + (terms->Phi_t ? terms->Phi_t[k] : 0);
        if (fabs(Psi) > VIOLATION * speed || fabs(zd_row_times(&row, vdot) - (terms->xi ? terms->xi[k] : 0)) > VIOLATION * size) return 1;
    }
    return zd_largest(point->system->mh, terms->Phi) > VIOLATION * length;
}

/* ---- the tangent space ---- */

static void factor_constraints(inverse *self)
{
    const int n = self->n, m = self->m;
    double *row = self->rows.A, longest = 0;
    for (int i = 0; i < m; i++) {
        self->length[i] = zd_point_scaled_row(self->point, i, self->given->scale, row + i * n);
        longest = fmax(longest, self->length[i]);
    }
    for (int i = 0; i < m; i++, row += n) {
        if (!(self->length[i] > 0)) continue;
        self->length[i] = fmax(self->length[i], DEPENDENT * longest);
        for (int j = 0; j < n; j++) row[j] /= self->length[i];
    }
    zd_row_space_factor(&self->rows, m, DEPENDENT, 0);
    self->freedoms = n - self->rows.rank;
}

/* Z, and the lower triangle of its products in the metric of M */
static void find_basis(inverse *self, double *products)
{
    const int n = self->n, k = self->freedoms;
    const double *scale = self->given->scale, *M = k == n ? zd_dense_M(self->point, products) : NULL;
    for (int i = 0; i < n && M; i++)
        for (int j = 0; j <= i; j++) products[i * n + j] = M[i * n + j] * scale[i] * scale[j];
    for (int i = 0; i < k && !M; i++) {
        double *z = self->Z + i * n;
        memset(z, 0, (size_t)n * sizeof *z);
        z[n - k + i] = 1;
        zd_row_space_turn_back(&self->rows, z);
        for (int j = 0; j < n; j++) z[j] *= scale[j];
        zd_times_M(self->point, self->point->terms.M, z, self->x);
        for (int j = 0; j <= i; j++) products[i * k + j] = zd_dot(n, self->Z + j * n, self->x);
    }
}

static int find_tangent(inverse *self)
{
    factor_constraints(self);
    const int k = self->freedoms;
    double *L = self->L, least = INFINITY;
    find_basis(self, L);
    if (ZD_SIZED(zd_cholesky, k, L, L) < k) return ZD_NOT_DEFINITE;
    self->mobility = 0;
    for (int i = 0; i < k; i++) self->mobility = fmax(self->mobility, L[i * k + i]), least = fmin(least, L[i * k + i]);
    return least > MASSLESS * self->mobility ? ZD_DONE : ZD_NOT_DEFINITE;
}

/* to (count, r) <- Z x of forces x (count, nv) */
static void project(const inverse *self, int count, const double *x, double *to)
{
    const int n = self->n, k = self->freedoms;
    for (int j = 0; j < count; j++, x += n)
        for (int i = 0; i < k; i++) to[j * k + i] = k < n ? zd_dot(n, self->Z + i * n, x) : self->given->scale[i] * x[i];
}

/* ---- efforts and multipliers ---- */

/* u (efforts,) <- efforts on the tangent space. An effort that the constraints take up does not count there: its part is rounding of its
 * whole, whose row counts as at least one radian or characteristic length, as at a dead point it may be rounding itself. */
static void find_efforts(inverse *self, const double *rows, double *u)
{
    const zd_given_motion *given = self->given;
    const int n = self->n, k = self->freedoms, count = given->efforts;
    double largest = 0, *acting = self->acting.A, *along = self->projected + count * k;
    for (int j = 0; j < count; j++)
        largest = fmax(largest, given->weight[j] * fmax(fmin(given->length, 1), zd_largest_scaled(n, rows + j * n, given->scale)));
    for (int i = 0; i < k; i++, acting += count) {
        const double share = sqrt(self->L[i * k + i]);
        for (int j = 0; j < count; j++) acting[j] = share * given->weight[j] * self->projected[j * k + i];
        along[i] *= share;
    }
    zd_row_space_prepare(&self->acting, k, 0, DEPENDENT * largest * sqrt(self->mobility));
    zd_row_space_solve(&self->acting, along, u);
    for (int j = 0; j < count; j++) u[j] *= given->weight[j];
}

/* Multipliers across the tangent space with the least sum of (lambda size)^2 */
static void find_least(inverse *self, const double *force, double *lambda)
{
    const int n = self->n, m = self->m;
    double *L = self->Z, *row = self->x, *A = self->redundant.A;
    const int has_mass = zd_cholesky(n, zd_dense_M(self->point, L), L) == n;
    for (int i = 0; i < m; i++) {
        const zd_row_of_C of = zd_point_row(self->point, i);
        zd_row_expand(&of, n, row);
        for (int j = 0; j < n; j++) A[j * m + i] = self->length[i] > 0 ? row[j] * self->given->scale[j] : 0;
        zd_forward(n, L, row, row);
        self->size[i] = !(self->length[i] > 0) ? 1 : has_mass ? sqrt(zd_metric_dot(n, L, row, row)) : self->length[i];
    }
    for (int j = 0; j < n * m; j++) A[j] /= self->size[j % m];
    zd_row_space_factor(&self->redundant, n, DEPENDENT, 0);
    zd_row_space_solve(&self->redundant, force, lambda);
    for (int i = 0; i < m; i++) lambda[i] /= self->size[i];
}

/* lambda (m,) <- multipliers with C^T lambda = right, in the least-squares sense in scaled velocities */
static void find_multipliers(inverse *self, double *lambda)
{
    const zd_row_space *rows = &self->rows;
    const int n = self->n, m = self->m;
    double *force = self->across;
    for (int j = 0; j < n; j++) force[j] = self->given->scale[j] * self->right[j];
    if (rows->rank < m) {
        find_least(self, force, lambda);
        return;
    }
    zd_row_space_turn(rows, force);
    for (int k = m - 1; k >= 0; k--) {
        for (int i = k + 1; i < m; i++) force[k] -= rows->A[i * n + k] * lambda[rows->order[i]];
        lambda[rows->order[k]] = force[k] / rows->diagonal[k];
    }
    for (int i = 0; i < m; i++) lambda[i] /= self->length[i];
}

/* Sample i, whose motion satisfies the constraints */
static void solve(inverse *self, int64_t i, const zd_needed_efforts *to)
{
    const zd_given_motion *given = self->given;
    const zd_point *point = self->point;
    const int n = self->n, k = self->freedoms, count = given->efforts;
    const double *rows = given->rows + i * count * n;
    double *u = to->effort + i * count, *right = self->right, *along = self->projected + count * k;
    zd_times_M(point, point->terms.M, given->vdot + i * n, self->wanted);
    if (!given->force) zd_point_force(point, self->x);
    zd_subtract(n, self->wanted, given->force ? given->force + i * n : self->x, self->wanted);
    project(self, count, rows, self->projected);
    project(self, 1, self->wanted, along);
    ZD_SIZED(zd_forward_rows, k, count + 1, self->L, self->projected, self->projected);
    to->wanted[i] = sqrt(zd_metric_dot(k, self->L, along, along));
    find_efforts(self, rows, u);
    to->rank[i] = self->acting.rank;
    memset(right, 0, (size_t)n * sizeof *right);
    for (int j = 0; j < count; j++) zd_add_scaled(n, right, u[j], rows + j * n);
    to->power[i] = zd_dot(n, right, point->v);
    zd_subtract(n, right, self->wanted, right);
    project(self, 1, right, along);
    ZD_SIZED(zd_forward, k, self->L, along, along);
    to->residual[i] = sqrt(zd_metric_dot(k, self->L, along, along));
    find_multipliers(self, to->multipliers + i * self->m);
}

int zd_inverse_dynamics(const zd_given_motion *given, zd_needed_efforts *to)
{
    const int needs = ZD_M | ZD_PHI | ZD_C | ZD_PHI_T | ZD_XI | (given->force ? 0 : ZD_FORCE | ZD_BIAS);
    const int64_t nq = given->system->nq, nv = given->system->nv;
    zd_store store = {NULL};
    inverse *self = zd_store_create(&store, create, given);
    int status = self ? ZD_DONE : ZD_NO_MEMORY;
    for (int64_t i = 0; i < given->states && !status; i++) {
        to->sample = i;
        zd_point_move(self->point, given->t[i], given->p + i * nq, given->v + i * nv);
        status = zd_point_check_domain(self->point, 0, 0);
        if (!status) status = zd_point_need(self->point, needs);
        if (!status) status = zd_point_measure(self->point);
        if (!status && is_violated(self, given->vdot + i * nv)) status = ZD_BAD_START;
        if (!status) status = find_tangent(self);
        if (!status) solve(self, i, to);
    }
    zd_store_release(&store);
    return status;
}
