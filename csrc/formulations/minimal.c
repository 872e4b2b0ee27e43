/* The equations of motion in independent velocities,
 *
 *     D^T M D udot = D^T (f - d - M gamma),    vdot = D udot + gamma,    C gamma = xi,        (17)
 *
 * and with the multipliers from C^T lambda = f - d - M vdot.
 */
#include "minimal.h"

#include <math.h>

#include "../constraints/limits.h"
#include "../constraints/rank.h"
#include "../linalg/small.h"
#include "../point/point.h"

enum { MAX_ITERATIONS = 12 };
static const double SETTLED = 0x1p-46;  /* change relative to the speed with which the velocity has converged */
static const double NEARLY = 0x1p-30;   /* change relative to the speed that is accepted if it no longer halves */

zd_minimal zd_minimal_create(zd_arena *arena, const zd_system *system, double *workspace)
{
    size_t n = system->nv, r = n - (size_t)zd_constraints(system);
    return (zd_minimal){
        .complement = zd_complement_create(arena, system, workspace),
        .memory = zd_create_dense(arena, system, n * n),
        .Mu = zd_arena_doubles(arena, n * n),
        .size = (int)r,
        .u = zd_arena_doubles(arena, n),
        .b = zd_arena_doubles(arena, n),
        .du = zd_arena_doubles(arena, n),
    };
}

zd_minimal zd_minimal_create_many(zd_arena *arena, const zd_system *system)
{
    return (zd_minimal){.many = zd_partition_sparse_create(arena, system)};
}

int zd_minimal_factor(void *memory, zd_point *point)
{
    zd_minimal *self = memory;
    if (self->many) return zd_structured_factor(self->many->structured, point, 0);
    int status = zd_complement_at(&self->complement, point);
    if (status) return status;
    self->M = zd_dense_M(point, self->memory);
    zd_complement_mass(&self->complement, self->M, self->Mu);
    const int r = self->complement.r;
    point->failed_index = ZD_SIZED(zd_cholesky, r, self->Mu, self->Mu);
    return point->failed_index < r ? ZD_NOT_DEFINITE : ZD_DONE;
}

/* b = force - M x */
static void unbalanced(zd_minimal *self, const double *force, const double *x)
{
    int n = self->complement.n;
    for (int i = 0; i < n; i++) self->b[i] = (force ? force[i] : 0) - zd_dot(n, self->M + i * n, x);
}

void zd_minimal_solve(void *memory, const double *force, const double *rhs, double *x, double *lambda)
{
    zd_minimal *self = memory;
    int r = self->complement.r;
    if (self->many) {
        zd_structured_solve(self->many->structured, force, rhs, x, lambda);
        return;
    }
    zd_complement_particular(&self->complement, rhs, x);                /* gamma */
    unbalanced(self, force, x);
    zd_complement_project(&self->complement, self->b, self->du);
    zd_forward(r, self->Mu, self->du, self->du);
    zd_backward(r, self->Mu, self->du, self->du);                       /* (17): udot */
    zd_complement_add(&self->complement, self->du, x);                  /* (15) */
    if (!lambda) return;
    unbalanced(self, force, x);
    zd_complement_multipliers(&self->complement, self->b, lambda);
}

/* Check that u determines the velocity: it does not if fewer constraints are independent than when the state was laid out. */
static int check_size(const zd_minimal *self)
{
    return self->complement.r == self->size ? ZD_DONE : ZD_BIFURCATION;
}

/* Sets v of the point from u; *change is the change of v, in characteristic scales. */
static int update_velocity(zd_minimal *self, zd_point *point, double *change)
{
    int status = zd_complement_velocity(&self->complement, point, self->u, self->b);
    if (!status) status = check_size(self);
    if (status) return status;
    for (int i = 0; i < self->complement.n; i++) self->du[i] = self->b[i] - point->v[i];
    *change = zd_max_scaled(self->complement.n, self->du, point->inverse_unit);
    zd_point_move_velocity(point, self->b);
    return ZD_DONE;
}

/* Velocity at a bifurcation. u determines it on each branch, but not the branch. The branch is taken whose velocity is nearest to the
 * extrapolation with the last known acceleration. Limits depend on the velocity, so that this is Newton's iteration for c(v) = 0 of
 * limits.c. */
static int update_on_branch(zd_minimal *self, zd_point *point)
{
    zd_copy(self->complement.n, point->v, self->b);
    zd_add_scaled(self->complement.n, self->b, self->lead_time, point->vdot);
    zd_point_move_velocity(point, self->b);
    self->lead_time = 0;
    double change = INFINITY, before;
    for (int i = 0; i < MAX_ITERATIONS; i++) {
        before = change;
        int status = i ? zd_rows_find_again(point) : ZD_DONE;
        if (!status) status = update_velocity(self, point, &change);
        if (status) return status;
        const double speed = point->rank->selection->limits->speed;
        if (change <= SETTLED * speed || (change <= NEARLY * speed && change >= before / 2)) return ZD_DONE;
    }
    return ZD_BIFURCATION;
}

int zd_minimal_update(void *memory, zd_point *point)
{
    zd_minimal *self = memory;
    if (self->many) return zd_partition_sparse_update(self->many, point);
    int status = zd_complement_at(&self->complement, point);
    if (!status && point->rank->lost) return update_on_branch(self, point);
    if (!status) status = check_size(self);
    if (!status) status = zd_complement_velocity(&self->complement, point, self->u, self->b);
    if (!status) zd_point_move_velocity(point, self->b);
    return status;
}

void zd_minimal_note_lead_time(zd_minimal *self, const zd_point *point, double t)
{
    self->lead_time = point->known & ZD_ACCELERATED ? t - point->t : 0;
}

int zd_minimal_unpack(zd_minimal *self, zd_point *point, const double *u)
{
    const int size = self->many ? self->many->size : self->size;
    zd_copy_all(size, u, self->many ? self->many->u : self->u);
    return zd_minimal_update(self, point);
}

int zd_minimal_express(zd_minimal *self, zd_point *point, double *u)
{
    if (self->many) {
        zd_partition_sparse_express_speeds(self->many, point, u);
        return ZD_DONE;
    }
    int status = zd_complement_at(&self->complement, point);
    if (!status) status = check_size(self);
    if (!status) status = zd_point_need(point, ZD_PHI_T);
    if (!status) status = zd_complement_speeds(&self->complement, point, self->u);
    for (int j = 0; j < self->size && !status; j++) u[j] = self->u[j];
    self->lead_time = 0;
    return status;
}

int zd_minimal_pack(zd_minimal *self, zd_point *point, double *u)
{
    if (self->many) return zd_partition_sparse_speeds(self->many, point, u);
    int status = zd_complement_review(&self->complement, point);
    return status ? status : zd_minimal_express(self, point, u);
}

int zd_minimal_rate(zd_minimal *self, zd_point *point, double *udot)
{
    if (!self->many) return zd_complement_rate(&self->complement, point, udot);
    zd_partition_sparse_pick_speeds(self->many, point->vdot, udot);
    return ZD_DONE;
}

int zd_minimal_tangents(zd_minimal *self, zd_point *point, const double *Psi_along, int positions, double *T)
{
    zd_complement *complement = &self->complement;
    const int nq = point->system->nq, n = point->system->nv, m = zd_constraints(point->system);
    if (self->many || complement->own || point->rank->lost) return ZD_SINGULAR;
    for (int i = 0; i < positions; i++, T += nq + n) {
        for (int k = 0; k < complement->m; k++) point->rhs[k] = -Psi_along[i * m + zd_independent_constraint(point, k)];
        zd_complement_particular(complement, point->rhs, T + nq);           /* (14): C dv = -Psi_p dp, with du = 0, */
    }
    for (int j = 0; j < self->size; j++, T += nq + n) {
        zd_clear(nq, T);
        for (int i = 0; i < n; i++) T[nq + i] = complement->D[i * complement->r + j];       /* and dv = D du */
    }
    return ZD_DONE;
}

int zd_minimal_may_have_entries(const zd_system *system)
{
    return !(system->provides & ZD_COMPLEMENT) && !zd_rank_is_of_many(system);
}

int zd_minimal_entries(const void *memory, zd_entries *entries)
{
    const zd_minimal *self = memory;
    const zd_complement *complement = &self->complement;
    *entries = (zd_entries){NULL, complement->order + complement->m, zd_complement_steepest(complement)};
    return !self->many && complement->r == self->size && entries->steepest > 0;
}
