/* Variable partitioning (16), or a system's own complement, behind one interface. */
#include "complement.h"

#include <math.h>

#include "../constraints/limits.h"
#include "../constraints/rank.h"
#include "../linalg/dense.h"
#include "../linalg/small.h"
#include "../point/point.h"

/* Factor by which the entries of W^-1 U may grow before u is selected anew. Complete pivoting keeps them near one; the motion is the
 * harder to integrate the larger they are, as w then depends steeply on u. The margin prevents two equally good selections from
 * alternating. */
static const double WORSE = 1.1;

zd_complement zd_complement_create(zd_arena *arena, const zd_system *system, double *workspace)
{
    size_t n = system->nv, m = zd_constraints(system), r = n - m;
    int own = (system->provides & ZD_COMPLEMENT) != 0;
    return (zd_complement){
        .n = (int)n,
        .m = (int)m,
        .r = (int)r,
        .is_provided = own,
        .own = own,
        .order = zd_arena_ints(arena, n),
        .pivots = zd_arena_ints(arena, n),
        .memory = zd_create_dense(arena, system, m * n),
        .D = zd_arena_doubles(arena, n * n),
        .K = zd_arena_doubles(arena, own ? n * n : m * m),
        .gram = zd_arena_doubles(arena, own ? r * r : 0),
        .work = zd_arena_doubles(arena, 2 * n),
        .choice = workspace,
    };
}

/* ---- by variable partitioning ---- */

static int choose(zd_complement *self, zd_point *point)
{
    for (int k = 0; k < self->m; k++) {     /* characteristic scales */
        const double inverse = point->inverse_size[zd_independent_constraint(point, k)];
        for (int j = 0; j < self->n; j++) self->choice[k * self->n + j] = self->C[k * self->n + j] * point->unit[j] * inverse;
    }
    int rank = zd_choose_columns(self->m, self->n, 0, self->choice, self->order);
    point->failed_index = rank;
    self->chosen = rank == self->m;
    self->reference = 0;
    return self->chosen ? ZD_DONE : ZD_DEPENDENT_ROWS;
}

void zd_complement_prefer(zd_complement *self, const int *independent)
{
    int dependents = 0;
    for (int i = 0; i < self->n; i++) {
        int wanted = 0;
        for (int j = 0; j < self->r; j++) wanted |= independent[j] == i;
        if (!wanted) self->order[dependents++] = i;
    }
    for (int j = 0; j < self->r; j++) self->order[self->m + j] = independent[j];
    self->chosen = 1;
    self->reference = 0;
}

/* D = [I; -W^-1 U], rows in the order of v. (16) */
static void fill_partitioned(zd_complement *self, const zd_point *point)
{
    int n = self->n, m = self->m, r = self->r;
    const double *C = self->C;
    self->largest = 0;
    zd_clear(n * r, self->D);
    for (int j = 0; j < r; j++) {
        int column = self->order[m + j];
        for (int k = 0; k < m; k++) self->work[k] = -C[k * n + column];
        zd_lu_solve(m, self->K, self->pivots, self->work);
        for (int k = 0; k < m; k++) {
            self->D[self->order[k] * r + j] = self->work[k];
            self->largest = fmax(self->largest, fabs(self->work[k]) * point->inverse_unit[self->order[k]] * point->unit[column]);
        }
        self->D[column * r + j] = 1;
    }
    if (self->reference == 0) self->reference = fmax(1, self->largest);
}

static int partition(zd_complement *self, zd_point *point)
{
    int n = self->n, m = self->m;
    const double *C = self->C;
    if (!self->chosen) {
        int status = choose(self, point);
        if (status) return status;
    }
    for (int k = 0; k < m; k++)
        for (int j = 0; j < m; j++) self->K[k * m + j] = C[k * n + self->order[j]];
    point->failed_index = zd_lu_factor(m, self->K, self->pivots);
    if (point->failed_index < m) return ZD_DEPENDENT_ROWS;
    fill_partitioned(self, point);
    return ZD_DONE;
}

/* ---- provided by the system ---- */

static int adopt(zd_complement *self, zd_point *point)
{
    int n = self->n, m = self->m, r = self->r;
    zd_copy_all(n * r, point->terms.D, self->D);
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++) self->K[i * n + j] = i < m ? self->C[i * n + j] : self->D[j * r + i - m];
    point->failed_index = zd_lu_factor(n, self->K, self->pivots);
    if (point->failed_index < n) return ZD_DEPENDENT_ROWS;
    for (int a = 0; a < r; a++)
        for (int b = 0; b < r; b++) {
            double sum = 0;
            for (int i = 0; i < n; i++) sum += self->D[i * r + a] * self->D[i * r + b];
            self->gram[a * r + b] = sum;
        }
    return zd_cholesky(r, self->gram, self->gram) == r ? ZD_DONE : ZD_DEPENDENT_ROWS;
}

static void take_rows(zd_complement *self, const zd_point *point)
{
    if (point->rows != self->m) self->chosen = 0;
    self->m = point->rows;
    self->C = zd_dense_C(point, self->memory);
    self->r = self->n - self->m;
    self->own = self->is_provided && zd_rank_is_full(point);
}

int zd_complement_at(zd_complement *self, zd_point *point)
{
    if (point->known & ZD_COMPLEMENTED) return ZD_DONE;
    int status = zd_point_need(point, self->is_provided ? ZD_C | ZD_COMPLEMENT : ZD_C);
    if (!status) status = zd_find_independent(point);
    if (status) return status;
    take_rows(self, point);
    status = self->own ? adopt(self, point) : partition(self, point);
    if (!status) point->known |= ZD_COMPLEMENTED;
    return status;
}

int zd_complement_review(zd_complement *self, zd_point *point)
{
    int was_chosen = self->chosen, status = zd_complement_at(self, point);
    int is_bad = status == ZD_DEPENDENT_ROWS || (!status && self->largest > WORSE * self->reference);
    if (self->own || !was_chosen || !is_bad) return status;
    point->statistics->repartitions++;
    self->chosen = 0;
    point->known &= ~(ZD_COMPLEMENTED | ZD_FACTORED | ZD_ACCELERATED);
    return zd_complement_at(self, point);
}

double zd_complement_steepest(const zd_complement *self)
{
    return self->chosen && !self->own ? WORSE * self->reference : 0;
}

void zd_complement_particular(const zd_complement *self, const double *rhs, double *x)
{
    int n = self->n, m = self->m;
    zd_clear(n, x);
    if (self->own) {
        zd_copy(m, rhs, x);
        zd_lu_solve(n, self->K, self->pivots, x);
        return;
    }
    double *w = self->work;
    zd_copy(m, rhs, w);
    zd_lu_solve(m, self->K, self->pivots, w);
    for (int k = 0; k < m; k++) x[self->order[k]] = w[k];
}

void zd_complement_multipliers(const zd_complement *self, const double *reaction, double *lambda)
{
    int size = self->own ? self->n : self->m;
    double *b = self->work;
    for (int i = 0; i < size; i++) b[i] = reaction[self->own ? i : self->order[i]];
    zd_lu_solve_transposed(size, self->K, self->pivots, b);
    zd_copy(self->m, b, lambda);
}

/* x with C x = -Phi_t, or with the right-hand side of the limits for constraints lost at a bifurcation. */
static int enforce(const zd_complement *self, zd_point *point, double *x)
{
    const double *Phi_t = point->terms.Phi_t;
    zd_clear(self->n, x);
    if (!Phi_t && !point->rank->lost) return ZD_DONE;
    double *all = point->rank->rhs, *rhs = point->rhs;
    for (int k = 0; k < zd_constraints(point->system); k++) all[k] = Phi_t ? -Phi_t[k] : 0;
    int status = zd_limits_replace(point, ZD_LIMIT_ENFORCED, all);
    for (int k = 0; k < self->m; k++) rhs[k] = all[zd_independent_constraint(point, k)];
    if (!status) zd_complement_particular(self, rhs, x);
    return status;
}

int zd_complement_velocity(zd_complement *self, zd_point *point, const double *u, double *v)
{
    int status = zd_complement_at(self, point);
    if (!status) status = zd_point_need(point, ZD_PHI_T);
    if (!status) status = enforce(self, point, v);
    if (!status) zd_complement_add(self, u, v);                         /* (14) */
    return status;
}

/* u with D u = x, in the sense of least squares; x is destroyed */
static void invert(const zd_complement *self, double *x, double *u)
{
    zd_complement_project(self, x, u);
    zd_forward(self->r, self->gram, u, u);
    zd_backward(self->r, self->gram, u, u);
}

void zd_complement_pick(const zd_complement *self, const double *x, double *of_u)
{
    for (int j = 0; j < self->r; j++) of_u[j] = x[self->order[self->m + j]];
}

int zd_complement_speeds(const zd_complement *self, zd_point *point, double *u)
{
    const double *v = point->v;
    if (!self->own) {
        zd_complement_pick(self, v, u);
        return ZD_DONE;
    }
    double *x = self->work + self->n;
    int status = enforce(self, point, x);
    for (int i = 0; i < self->n; i++) x[i] = v[i] - x[i];
    invert(self, x, u);
    return status;
}

int zd_complement_rate(zd_complement *self, zd_point *point, double *udot)
{
    if (!self->own) {
        zd_complement_pick(self, point->vdot, udot);
        return ZD_DONE;
    }
    int status = zd_point_need(point, ZD_GAMMA);
    if (status) return status;
    double *x = self->work + self->n;
    for (int i = 0; i < self->n; i++) x[i] = point->vdot[i] - point->terms.gamma[i];
    invert(self, x, udot);                                              /* (15) */
    return ZD_DONE;
}

void zd_complement_project(const zd_complement *self, const double *b, double *projected)
{
    int n = self->n, r = self->r;
    zd_clear(r, projected);
    for (int i = 0; i < n; i++)
        for (int j = 0; j < r; j++) projected[j] += self->D[i * r + j] * b[i];
}

void zd_complement_add(const zd_complement *self, const double *u, double *x)
{
    int n = self->n, r = self->r;
    for (int i = 0; i < n; i++)
        for (int j = 0; j < r; j++) x[i] += self->D[i * r + j] * u[j];
}

void zd_complement_mass(const zd_complement *self, const double *M, double *Mu)
{
    int n = self->n, r = self->r;
    double *column = self->work;
    for (int b = 0; b < r; b++) {
        for (int i = 0; i < n; i++) {
            double sum = 0;
            for (int j = 0; j < n; j++) sum += M[i * n + j] * self->D[j * r + b];
            column[i] = sum;
        }
        for (int a = 0; a < r; a++) {
            double sum = 0;
            for (int i = 0; i < n; i++) sum += self->D[i * r + a] * column[i];
            Mu[a * r + b] = sum;
        }
    }
}
