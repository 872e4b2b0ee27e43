/* Derivatives of the rate with respect to the state, for implicit integrators. Those of (pdot, vdot) and the power along a direction of
 * (p, v) come from the system's own J where it has one, else from the derivatives of the residuals, with vdot and lambda at the state:
 *
 *     M dvdot + C^T dlambda = -dr,    C dvdot = -ds          (8), with the factors at the state
 *
 * Where the state y is (p, v), that is all. In independent velocities (p, v) = (g(q), D u + particular(-Phi_t)), and of their rates the state
 * has some entries: with T = d(p, v)/dy,
 *
 *     d(ydot)/dy = pick(J T),     Phi_p dp = 0 with dq given          (18); of (17), all p are q
 *                                 C dv = -Psi_p dp with du given      (14), of Psi = C v + Phi_t, (5)
 *
 * The formulation solves for these, and with unit quaternions knows what of dp and pdot is the increments'. Psi_p dp comes from the system
 * or from the same residuals: from J it follows only of holonomic rows where pdot = v, as C d(vdot)/dv = -2 Psi_p.
 */
#include <string.h>

#include "../linalg/small.h"
#include "motion.h"

static int jacobian(void *context, double t, const double *y, const double *increment, double *J);

static size_t larger(size_t a, size_t b) { return a > b ? a : b; }

void zd_motion_create_jacobian(zd_motion *motion, zd_arena *arena)
{
    const zd_system *system = &motion->system;
    const size_t nq = system->nq, nv = system->nv, m = zd_constraints(system), width = nq + nv;
    const size_t size = motion->formulation_size;
    const int has_tangents = motion->formulation->tangents_of_p != NULL;
    const int has_own = has_tangents && system->jacobian && system->jacobian->constraints;
    motion->chain = (zd_chain){
        .residuals = zd_residual_state_create(arena, system, &motion->statistics, ZD_FOR_ITERATIONS),
        .lambda = zd_arena_doubles(arena, m),
        .changes = zd_arena_doubles(arena, width + m + 1),
        .right = zd_arena_doubles(arena, nv + m),
        .lambda_along = zd_arena_doubles(arena, m),
        .unit = zd_arena_doubles(arena, width),
        .scratch = system->jacobian ? zd_arena_doubles(arena, system->jacobian->scratch) : NULL,
        .J = has_own ? zd_arena_doubles(arena, (width + 1) * width) : NULL,
        .Psi_p = has_own ? zd_arena_doubles(arena, m * nq + 1) : NULL,
        .Psi_along = has_tangents ? zd_arena_doubles(arena, size * m) : NULL,
        .T = has_tangents ? zd_arena_doubles(arena, size * width) : NULL,
        .rates = zd_arena_doubles(arena, width + 1),
        .picked = zd_arena_doubles(arena, larger(size, width)),
    };
    if (motion->point) zd_residual_state_begin(&motion->chain.residuals, 0, motion->point, motion->point->vdot, motion->chain.lambda);
    motion->rate.jacobian = jacobian;
}

/* ---- derivatives along one direction ---- */

/* The multipliers with which r = 0 that belong to the independent constraints alone, as the rate does */
static void find_multipliers(zd_motion *motion)
{
    zd_point *point = motion->point;
    const zd_chain *chain = &motion->chain;
    const int m = zd_constraints(point->system);
    if (zd_rank_is_full(point)) {
        zd_copy_all(m, point->lambda, chain->lambda);
        return;
    }
    zd_selection *selection = point->rank->selection;
    zd_point_force(point, point->force);
    for (int a = 0; a < point->rows; a++) selection->rhs[a] = point->terms.xi ? point->terms.xi[selection->row_at[a]] : 0;
    motion->statistics.solves++;
    motion->formulation->solve(motion->solver, point->force, selection->rhs, chain->right, selection->lambda);
    zd_clear(m, chain->lambda);
    for (int a = 0; a < point->rows; a++) chain->lambda[selection->row_at[a]] = selection->lambda[a];
}

/* Moves the point to the state; accelerations, multipliers and factors there */
static int move_there(zd_motion *motion, double t, const double *y)
{
    zd_point *point = motion->point;
    int status = motion->formulation->unpack(motion->solver, point, t, y);
    motion->state = y;
    if (!status) status = zd_motion_accelerate(motion);
    if (!status) status = zd_motion_factor(motion);
    if (!status && motion->balance.input) status = zd_point_need(point, ZD_PHI_T);
    if (status) return status;
    return zd_constraints(point->system) && point->rank->lost ? ZD_SINGULAR : ZD_DONE;
}

/* At the point, for differentiate() */
static void begin(zd_motion *motion)
{
    zd_point *point = motion->point;
    zd_chain *chain = &motion->chain;
    find_multipliers(motion);
    const int pdot = zd_has_A(&motion->system) ? ZD_RESIDUAL_PDOT : 0, power = motion->balance.input ? ZD_RESIDUAL_POWER : 0;
    zd_residual_state_begin(&chain->residuals, ZD_RESIDUAL_R | ZD_RESIDUAL_S | pdot | power, point, point->vdot, chain->lambda);
}

/* Derivative of the power, with that of the multipliers */
static double power_along(const zd_motion *motion, const double *lambda)
{
    const zd_point *point = motion->point;
    double sum = motion->chain.changes[motion->chain.residuals.power_at];
    for (int k = 0; k < point->rows && point->terms.Phi_t; k++) sum += lambda[k] * point->terms.Phi_t[zd_independent_constraint(point, k)];
    return sum;
}

/* chain.rates <- derivatives of pdot, vdot and power along a direction (nq + nv,) */
static int differentiate(zd_motion *motion, const double *direction, double increment)
{
    const zd_chain *chain = &motion->chain;
    const zd_point *point = motion->point;
    const int nq = motion->system.nq, nv = motion->system.nv, has_A = zd_has_A(&motion->system);
    double *right = chain->right, *rhs = right + nv, *vdot = chain->rates + nq, *lambda = motion->balance.input ? chain->lambda_along : NULL;
    const zd_direction along = {.p = direction, .v = direction + nq};
    int status = zd_residual_derivatives(&motion->chain.residuals, &along, increment, ZD_FOR_ITERATIONS, chain->changes);
    if (status) return status;
    for (int i = 0; i < nv; i++) right[i] = -chain->changes[i];
    for (int k = 0; k < point->rows; k++) rhs[k] = -chain->changes[nv + zd_independent_constraint(point, k)];
    motion->statistics.solves++;
    motion->formulation->solve(motion->solver, right, rhs, vdot, lambda);     /* (8) */
    zd_copy_all(nq, has_A ? chain->changes + chain->residuals.pdot_at : along.v, chain->rates);
    if (lambda) chain->rates[nq + nv] = power_along(motion, lambda);
    return ZD_DONE;
}

/* ---- tangents ---- */

/* chain.Psi_along by the Psi_p of the system */
static int apply_Psi_p(zd_motion *motion, int positions)
{
    const zd_chain *chain = &motion->chain;
    const zd_point *point = motion->point;
    const zd_system *system = &motion->system;
    const int nq = system->nq, m = zd_constraints(system), width = nq + system->nv;
    motion->statistics.evaluations++;
    int status = system->jacobian->constraints(system->data, point->terms.inputs, point->t, point->p, point->v, chain->Psi_p, chain->scratch);
    for (int i = 0; i < positions && !status; i++)
        for (int k = 0; k < m; k++) chain->Psi_along[i * m + k] = zd_dot(nq, chain->Psi_p + k * nq, chain->T + i * width);
    return status;
}

/* The same by the residuals */
static int differentiate_Psi(zd_motion *motion, int positions, const double *increment)
{
    zd_chain *chain = &motion->chain;
    zd_point *point = motion->point;
    const int m = zd_constraints(&motion->system), width = motion->system.nq + motion->system.nv;
    int status = ZD_DONE;
    zd_residual_state_begin(&chain->residuals, ZD_RESIDUAL_PSI, point, point->vdot, chain->lambda);
    for (int i = 0; i < positions && !status; i++) {
        const zd_direction along = {.p = chain->T + i * width};
        status = zd_residual_derivatives(&chain->residuals, &along, increment[i], ZD_FOR_ITERATIONS, chain->Psi_along + i * m);
    }
    return status;
}

/* T at the point, which is at the state */
static int find_tangents(zd_motion *motion, const double *increment)
{
    const zd_chain *chain = &motion->chain;
    const zd_formulation *formulation = motion->formulation;
    const int m = zd_constraints(&motion->system);
    int positions;
    if (!formulation->tangents_of_p) return ZD_SINGULAR;
    int status = formulation->tangents_of_p(motion->solver, motion->point, chain->T, &positions);
    if (!status && m) status = chain->Psi_p ? apply_Psi_p(motion, positions) : differentiate_Psi(motion, positions, increment);
    return status ? status : formulation->tangents_of_v(motion->solver, motion->point, chain->Psi_along, chain->T);
}

/* ---- the Jacobian of the rate ---- */

/* Column j of J <- pick(chain.rates) */
static void write_column(const zd_motion *motion, int j, double *J)
{
    const zd_chain *chain = &motion->chain;
    const int size = motion->rate.size, entries = motion->formulation_size, width = motion->system.nq + motion->system.nv;
    const int picks = motion->formulation->update != NULL;
    if (picks) motion->formulation->pick(motion->solver, motion->point, chain->rates, chain->rates + motion->system.nq, chain->picked);
    const double *column = picks ? chain->picked : chain->rates;
    for (int i = 0; i < entries; i++) J[i * size + j] = column[i];
    if (size > entries) J[entries * size + j] = chain->rates[width];        /* derivative of the energy input */
}

/* On the energy input no rate depends. */
static void clear_last_column(const zd_motion *motion, double *J)
{
    const int size = motion->rate.size, entries = motion->formulation_size;
    for (int i = 0; i < size && size > entries; i++) J[i * size + entries] = 0;
}

/* J (rows, columns) -> J (rows, rows): columns of zeros for entries of the state on which no rate depends */
static void widen(int rows, int columns, double *J)
{
    if (rows == columns) return;
    for (int i = rows - 1; i >= 0; i--) {
        memmove(J + i * rows, J + i * columns, columns * sizeof *J);
        for (int j = columns; j < rows; j++) J[i * rows + j] = 0;
    }
}

/* J <- the system's own Jacobian at the point */
static int evaluate(zd_motion *motion, const double *p, const double *v, double t, double *J)
{
    const zd_system *system = &motion->system;
    motion->statistics.evaluations++;
    return system->jacobian->evaluate(system->data, motion->rate.inputs, t, p, v, J, motion->chain.scratch) ? ZD_SINGULAR : ZD_DONE;
}

/* J <- pick(J T), column by column, of the system's own */
static int apply_chain(zd_motion *motion, double t, const double *y, const double *increment, double *J)
{
    const zd_chain *chain = &motion->chain;
    const zd_point *point = motion->point;
    const int width = motion->system.nq + motion->system.nv, entries = motion->formulation_size;
    if (!chain->J) return ZD_SINGULAR;
    int status = motion->formulation->unpack(motion->solver, motion->point, t, y);
    motion->state = y;
    if (!status) status = find_tangents(motion, increment);
    if (!status) status = evaluate(motion, point->p, point->v, t, chain->J);
    for (int j = 0; j < entries && !status; j++) {
        for (int i = 0; i < width + motion->rate.size - entries; i++)
            chain->rates[i] = zd_dot(width, chain->J + i * width, chain->T + j * width);
        write_column(motion, j, J);
    }
    clear_last_column(motion, J);
    return status;
}

static int take_own(zd_motion *motion, double t, const double *y, const double *increment, double *J)
{
    const int nq = motion->system.nq;
    if (motion->formulation->update) return apply_chain(motion, t, y, increment, J);
    int status = evaluate(motion, y, y + nq, t, J);
    if (!status) widen(motion->rate.size, nq + motion->system.nv, J);
    return status;
}

/* By the residuals */
static int take_by_residuals(zd_motion *motion, double t, const double *y, const double *increment, double *J)
{
    const zd_chain *chain = &motion->chain;
    const int width = motion->system.nq + motion->system.nv, updates = motion->formulation->update != NULL;
    int status = move_there(motion, t, y);
    if (!status && updates) status = find_tangents(motion, increment);
    if (!status) begin(motion);
    zd_clear(width, chain->unit);
    for (int j = 0; j < motion->formulation_size && !status; j++) {
        if (!updates) chain->unit[j] = 1;
        status = differentiate(motion, updates ? chain->T + j * width : chain->unit, increment[j]);
        if (!updates) chain->unit[j] = 0;
        if (!status) write_column(motion, j, J);
    }
    clear_last_column(motion, J);
    return status;
}

static int jacobian(void *context, double t, const double *y, const double *increment, double *J)
{
    zd_motion *motion = context;
    const int size = motion->rate.size;
    int status = ZD_SINGULAR;
    if (motion->is_stabilized || motion->corrections_size || motion->reactions.reading) return status;
    if (motion->system.jacobian) status = take_own(motion, t, y, increment, J);
    if (status) status = take_by_residuals(motion, t, y, increment, J);
    if (status) return status;
    return zd_is_finite(size * size, J) ? ZD_DONE : ZD_NOT_FINITE;
}
