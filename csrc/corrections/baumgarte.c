/* Baumgarte's stabilization: the violations are fed back into the right side of (6). */
#include "../core.h"

static int enabled(const zd_settings *settings)
{
    return settings->baumgarte.on;
}

static void *take(zd_arena *arena, const zd_system *system)
{
    return zd_take_doubles(arena, (size_t)zd_constraints(system));
}

static void stabilize(void *memory, const zd_settings *settings, const zd_point *point, double *rhs)
{
    double *Psi = memory;
    const zd_system *system = point->system;
    zd_point_velocity_violation(point, Psi);
    for (int k = 0; k < zd_constraints(system); k++) rhs[k] -= settings->baumgarte.alpha * Psi[k];      /* (23) */
    for (int k = 0; k < system->mh; k++) rhs[k] -= settings->baumgarte.beta * point->terms.Phi[k];      /* (23) */
}

const zd_correction zd_baumgarte_row = {
    .card = {"baumgarte", "Violations are fed back into the acceleration constraints, with gains alpha and beta.", "(23)", 0},
    .enabled = enabled,
    .needs = ZD_PHI | ZD_C | ZD_PHI_T,
    .take = take,
    .stabilize = stabilize,
};
