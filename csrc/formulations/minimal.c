/* The equations of motion in independent velocities,
 *
 *     D^T M D udot = D^T (f - d - M gamma),    vdot = D udot + gamma,    C gamma = xi,        (17)
 *
 * and with the multipliers from C^T lambda = f - d - M vdot.
 */
#include "minimal.h"

#include "../linalg/small.h"

zd_minimal zd_minimal_take(zd_arena *arena, const zd_system *system)
{
    size_t n = (size_t)system->nv;
    return (zd_minimal){
        .complement = zd_complement_take(arena, system),
        .Mu = zd_take_doubles(arena, n * n),
        .size = system->nv - zd_constraints(system),
        .u = zd_take_doubles(arena, n),
        .b = zd_take_doubles(arena, n),
        .du = zd_take_doubles(arena, n),
    };
}

int zd_minimal_factor(void *memory, zd_point *point)
{
    zd_minimal *self = memory;
    int r = self->complement.r;
    int status = zd_complement_at(&self->complement, point);
    if (status) return status;
    self->M = point->terms.M;
    zd_complement_mass(&self->complement, self->M, self->Mu);
    point->culprit = ZD_SIZED(zd_cholesky, r, self->Mu, self->Mu);
    return point->culprit < r ? ZD_NOT_DEFINITE : ZD_DONE;
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

/* Where fewer rows count than in the state, u is too short to say where the motion goes. */
static int check_size(const zd_minimal *self)
{
    return self->complement.r == self->size ? ZD_DONE : ZD_BIFURCATION;
}

int zd_minimal_settle(void *memory, zd_point *point)
{
    zd_minimal *self = memory;
    int status = zd_complement_at(&self->complement, point);
    if (!status) status = check_size(self);
    if (!status) status = zd_complement_velocity(&self->complement, point, self->u, self->b);
    if (!status) zd_point_move_velocity(point, self->b);
    return status;
}

int zd_minimal_enter(zd_minimal *self, zd_point *point, const double *u)
{
    for (int j = 0; j < self->size; j++) self->u[j] = u[j];
    return zd_minimal_settle(self, point);
}

int zd_minimal_leave(zd_minimal *self, zd_point *point, double *u)
{
    int status = zd_complement_review(&self->complement, point);
    if (!status) status = check_size(self);
    if (!status) status = zd_point_need(point, ZD_PHI_T);
    if (status) return status;
    zd_complement_speeds(&self->complement, point, self->u);
    for (int j = 0; j < self->size; j++) u[j] = self->u[j];
    return ZD_DONE;
}
