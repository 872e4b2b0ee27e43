/* Derivatives of the rate, as implicit integrators want them, from the system's own J, those of (pdot, vdot) by (p, v).
 *
 * Where the state y is (p, v), that is all. In independent velocities (p, v) = (g(q), D u + particular(-Phi_t)), and of their rates the state
 * has some entries: with T = d(p, v)/dy,
 *
 *     d(ydot)/dy = pick(J T),     Phi_p dp = 0 with dq given          (18); of (17), all p are q
 *                                 C dv = -Psi_p dp with du given      (14), of Psi = C v + Phi_t, (5)
 *
 * The formulation solves for these, and with unit quaternions knows what of dp and pdot is the increments'. Psi_p comes from the system, too:
 * from J it follows only of holonomic rows where pdot = v, as C d(vdot)/dv = -2 Psi_p.
 */
#include <string.h>

#include "../linalg/norms.h"
#include "../linalg/small.h"
#include "motion.h"

zd_chain zd_chain_take(const zd_motion *motion, zd_arena *arena)
{
    const zd_system *system = &motion->system;
    const size_t width = (size_t)(system->nq + system->nv), size = (size_t)motion->formulation_size;
    if (!system->jacobian) return (zd_chain){.scratch = NULL};
    zd_chain chain = {.scratch = zd_take_doubles(arena, (size_t)system->jacobian->scratch)};
    if (!motion->formulation->tangents || !system->jacobian->constraints) return chain;
    chain.J = zd_take_doubles(arena, (width + 1) * width);
    chain.Psi_p = zd_take_doubles(arena, (size_t)(zd_constraints(system) * system->nq));
    chain.T = zd_take_doubles(arena, size * width);
    chain.rates = zd_take_doubles(arena, width + 1);
    chain.picked = zd_take_doubles(arena, size);
    return chain;
}

/* J (rows, columns) -> J (rows, rows): columns of zeros for entries of the state on which no rate depends */
static void widen(int rows, int columns, double *J)
{
    if (rows == columns) return;
    for (int i = rows - 1; i >= 0; i--) {
        memmove(J + i * rows, J + i * columns, (size_t)columns * sizeof *J);
        for (int j = columns; j < rows; j++) J[i * rows + j] = 0;
    }
}

/* J <- the system's own Jacobian at the point */
static int evaluate(zd_motion *motion, const double *p, const double *v, double t, double *J)
{
    const zd_system *system = &motion->system;
    motion->statistics.evaluations++;
    return system->jacobian->evaluate(system->data, motion->rate.inputs, t, p, v, J, motion->chain.scratch);
}

/* T at the point, after it has been moved to the state */
static int find_tangents(zd_motion *motion, double t, const double *y)
{
    const zd_system *system = &motion->system;
    const zd_chain *chain = &motion->chain;
    zd_point *point = motion->point;
    if (!system->jacobian->constraints) return ZD_SINGULAR;
    int status = motion->formulation->enter(motion->solver, point, t, y);
    motion->state = y;
    if (status) return status;
    if (zd_constraints(system)) {
        motion->statistics.evaluations++;
        status = system->jacobian->constraints(system->data, point->terms.inputs, t, point->p, point->v, chain->Psi_p, chain->scratch);
    }
    return status ? status : motion->formulation->tangents(motion->solver, point, chain->Psi_p, chain->T);
}

/* J <- pick(J T), column by column */
static int apply_chain(zd_motion *motion, double t, const double *y, double *J)
{
    const zd_chain *chain = &motion->chain;
    const zd_point *point = motion->point;
    const int nq = motion->system.nq, width = nq + motion->system.nv, size = motion->rate.size, entries = motion->formulation_size;
    int status = find_tangents(motion, t, y);
    if (!status) status = evaluate(motion, point->p, point->v, t, chain->J);
    if (status) return status;
    for (int j = 0; j < entries; j++) {
        for (int i = 0; i < width + size - entries; i++) chain->rates[i] = zd_dot(width, chain->J + i * width, chain->T + j * width);
        motion->formulation->pick(motion->solver, point, chain->rates, chain->rates + nq, chain->picked);
        for (int i = 0; i < entries; i++) J[i * size + j] = chain->picked[i];
        if (size > entries) J[entries * size + j] = chain->rates[width];        /* derivative of the energy input */
    }
    for (int i = 0; i < size && size > entries; i++) J[i * size + entries] = 0;
    return ZD_DONE;
}

int zd_motion_jacobian(void *context, double t, const double *y, double *J)
{
    zd_motion *motion = context;
    const int nq = motion->system.nq, size = motion->rate.size;
    int status = ZD_SINGULAR;
    if (motion->is_stabilized || motion->corrections_size) return status;
    if (motion->formulation->settle) status = apply_chain(motion, t, y, J);
    else {
        status = evaluate(motion, y, y + nq, t, J);
        if (!status) widen(size, nq + motion->system.nv, J);
    }
    if (status) return status;
    return zd_is_finite(size * size, J) ? ZD_DONE : ZD_NOT_FINITE;
}
