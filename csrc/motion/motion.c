/* The motion at a point: solutions with the leading matrix, accelerations, the rate of the integrated state that follows, corrections after
 * a step, and the energy balance (28).
 */
#include <math.h>
#include <string.h>

#include "../constraints/limits.h"
#include "../constraints/rank.h"
#include "../linalg/small.h"
#include "../point/point.h"
#include "motion.h"

/* ---- leading matrix ---- */

int zd_motion_factor_anew(zd_motion *motion)
{
    zd_point *point = motion->point;
    int status = zd_point_need(point, motion->matrices);
    if (status) return status;
    motion->statistics.factorizations++;
    status = motion->formulation->factor(motion->solver, point);
    if (!status) point->known |= ZD_FACTORED;
    return status;
}

int zd_motion_find_independent(zd_motion *motion)
{
    zd_point *point = motion->point;
    const zd_formulation *formulation = motion->formulation;
    if (point->known & ZD_RANKED) return ZD_DONE;
    const int selects_rows = formulation->finds_independent && formulation->finds_independent(&motion->system);
    /* A failed factorization gives no selection; its error is reported by the caller that needs the factors. */
    if (selects_rows && zd_motion_factor(motion) == ZD_CALLBACK) return ZD_CALLBACK;
    return zd_find_independent(point);
}

static void solve_reduced(const zd_point *point, const zd_formulation *formulation, void *solver, const double *force,
                          const double *rhs, double *x, double *lambda)
{
    zd_selection *selection = point->rank->selection;
    int holonomic = point->holonomic - point->rank->lost, others = selection->independent - holonomic;
    for (int a = 0; a < point->rows; a++) selection->rhs[a] = rhs[selection->row_at[a]];
    formulation->solve(solver, force, selection->rhs, x, lambda ? selection->lambda : NULL);
    if (!lambda) return;
    selection->are_awaited = !selection->is_expressed;
    if (selection->are_awaited) {
        zd_copy_all(selection->independent, selection->lambda, selection->lambda_r);
        return;
    }
    memmove(selection->lambda + holonomic, selection->lambda + point->holonomic, others * sizeof(double));
    zd_rank_share_out(point, lambda);
}

void zd_solve_with(const zd_point *point, const zd_formulation *formulation, void *solver, const double *force, const double *rhs,
                   double *x, double *lambda)
{
    if (zd_rank_is_full(point)) formulation->solve(solver, force, rhs, x, lambda);
    else solve_reduced(point, formulation, solver, force, rhs, x, lambda);
}

void zd_motion_solve(zd_motion *motion, const double *force, const double *rhs, double *x, double *lambda)
{
    if (zd_rank_is_full(motion->point)) motion->formulation->solve(motion->solver, force, rhs, x, lambda);
    else solve_reduced(motion->point, motion->formulation, motion->solver, force, rhs, x, lambda);
}

/* ---- accelerations ---- */

void zd_motion_stabilize(zd_motion *motion)
{
    for (int i = 0; i < motion->corrections; i++) {
        const zd_active *active = &motion->active[i];
        if (active->row->stabilize)
            active->row->stabilize(active->self, motion->point, motion->state + motion->formulation_size + active->extra, motion->point->rhs);
    }
}

/* f - d; f itself if the system has no d */
static const double *find_force(const zd_point *point)
{
    if (point->terms.f && !point->terms.d) return point->terms.f;
    zd_point_force(point, point->force);
    return point->force;
}

static int accelerate(zd_motion *motion)
{
    zd_point *point = motion->point;
    int status = zd_point_need(point, motion->acceleration_needs);
    if (status) return status;
    const double *force = find_force(point);
    zd_copy_few(zd_constraints(point->system), point->terms.xi, point->rhs);
    if (motion->is_stabilized) zd_motion_stabilize(motion);
    status = zd_motion_factor_for(motion, force, point->rhs, point->vdot);
    if (!status) status = zd_limits_replace(point, ZD_LIMIT_XI, point->rhs);
    if (status) return status;
    motion->statistics.solves++;
    zd_motion_solve(motion, force, point->rhs, point->vdot, point->lambda);      /* (8), (9), (13) */
    point->known |= ZD_ACCELERATED;
    return ZD_DONE;
}

/* ---- rate of the integrated state ---- */

void zd_motion_extra_rates(const zd_motion *motion, double *ydot)
{
    for (int i = 0; i < motion->corrections; i++) {
        const zd_active *active = &motion->active[i];
        if (active->extra_size) active->row->extra_rate(motion->point, ydot + motion->formulation_size + active->extra);
    }
}

/* Power put in besides V: by forces, and by moving constraints, whose force -C^T lambda does work because C v = -Phi_t. */
static double find_power(const zd_motion *motion)
{
    const zd_point *point = motion->point;
    double sum = point->terms.power ? *point->terms.power : 0;
    if (point->terms.Phi_t) zd_rank_find_multipliers(point);
    if (point->terms.Phi_t)
        for (int k = 0; k < zd_constraints(point->system); k++) sum += point->lambda[k] * point->terms.Phi_t[k];
    return sum;
}

int zd_motion_rate(void *context, double t, const double *y, double *ydot)
{
    zd_motion *motion = context;
    int status = motion->formulation->unpack(motion->solver, motion->point, t, y);
    motion->state = y;
    if (motion->corrections_size) motion->point->known &= ~ZD_ACCELERATED;     /* vdot depends on the corrections' own state, too */
    if (!status) status = zd_motion_accelerate(motion);
    if (!status) status = motion->formulation->rate(motion->solver, motion->point, ydot);
    if (status) return status;
    if (motion->corrections_size) zd_motion_extra_rates(motion, ydot);
    if (motion->balance.input) ydot[motion->rate.size - 1] = find_power(motion);
    return ZD_DONE;
}

/* ---- the state and the point ---- */

int zd_motion_unpack(zd_motion *motion, double t, double *y)
{
    const zd_formulation *formulation = motion->formulation;
    /* If Phi drifts, the state begins with p; otherwise p has been normalised when it was computed. */
    if (formulation->drifts_from & ZD_PHI) zd_quaternions_normalise(&motion->system, y);
    return formulation->unpack(motion->solver, motion->point, t, y);
}

int zd_motion_pack(zd_motion *motion, double *y)
{
    return motion->formulation->pack(motion->solver, motion->point, y);
}

int zd_motion_finish(zd_motion *motion, double *y, int within)
{
    const zd_formulation *formulation = motion->formulation;
    zd_point_follow(motion->point);
    int status = within && formulation->update ? formulation->express(motion->solver, motion->point, y) : zd_motion_pack(motion, y);
    /* Dependent velocities are recomputed from the state to the last bit, so that the next step can start from quantities known here. */
    return !status && formulation->update ? formulation->update(motion->solver, motion->point) : status;
}

const zd_equations zd_equations_by_matrices = {
    accelerate, zd_motion_rate, zd_motion_unpack, zd_motion_pack, zd_motion_finish, zd_motion_expand, zd_motion_reduce, ~0, 1};

/* ---- corrections after a step ---- */

/* Applies those that are due, of which the projection alone has a target. */
ZD_INLINE int correct(zd_motion *motion, int64_t step, int forced, const int has_target)
{
    for (int i = 0; i < motion->corrections; i++) {
        const zd_active *active = &motion->active[i];
        if (!active->row->after_step || !(forced || zd_is_one_of(active->every, step))) continue;
        if ((active->row->target != NULL) != has_target) continue;
        int status = active->row->after_step(active->self, motion);
        if (status) return status;
    }
    return ZD_DONE;
}

int zd_motion_project(zd_motion *motion, int64_t step, int forced)
{
    return correct(motion, step, forced, 1);
}

int zd_motion_correct_rest(zd_motion *motion, int64_t step, int forced)
{
    return correct(motion, step, forced, 0);
}

int zd_motion_correct(zd_motion *motion)
{
    const int status = zd_motion_project(motion, 0, 1);
    return status ? status : zd_motion_correct_rest(motion, 0, 1);
}

int zd_motion_is_corrected(const zd_motion *motion, int64_t step)
{
    for (int i = 0; i < motion->corrections; i++)
        if (motion->active[i].row->after_step && !zd_is_one_of(motion->active[i].every, step)) return 0;
    return 1;
}

/* ---- energy balance ---- */

int zd_has_energy(const zd_system *system)
{
    return (system->provides & ZD_POTENTIAL) != 0;
}

int zd_has_input(const zd_system *system)
{
    return zd_has_energy(system) && (system->provides & (ZD_POWER | ZD_PHI_T));
}

int zd_motion_energy_violation(zd_motion *motion, double *violation, double *kinetic)
{
    const zd_point *point = motion->point;
    int status = zd_point_need(motion->point, ZD_M | ZD_POTENTIAL);
    if (status) return status;
    *kinetic = zd_point_kinetic(point);
    *violation = *kinetic + zd_point_potential(point) - motion->balance.initial - zd_motion_input(motion);     /* (28) */
    return isfinite(*violation) ? ZD_DONE : ZD_NOT_FINITE;
}

int zd_motion_balance(zd_motion *motion, double *violation)
{
    double kinetic;
    *violation = 0;
    return zd_has_energy(&motion->system) ? zd_motion_energy_violation(motion, violation, &kinetic) : ZD_DONE;
}

void zd_motion_add_jump(zd_motion *motion, double t, double energy)
{
    zd_balance *balance = &motion->balance;
    balance->initial += energy;
    balance->jump = (zd_energy_jump){balance->jump.count + 1, t, energy};
}

int zd_motion_start_energy(zd_motion *motion)
{
    return zd_motion_balance(motion, &motion->balance.initial);     /* E0 of (28), which is 0 here */
}
