/* Baumgarte's stabilization: the violations are fed back into the right side of (6), and so, if asked for, is the time integral
 * of the position violation, as the paper's reference [16] proposes. The integral is part of the integrated state.
 */
#include "../motion/motion.h"
#include "../point/matrices.h"

typedef struct baumgarte {
    zd_baumgarte gain;
    double *Psi;        /* (m,) */
} baumgarte;

static int every(const zd_settings *settings)
{
    return settings->baumgarte.on != 0;
}

static void *take(zd_arena *arena, const zd_system *system, const zd_settings *settings)
{
    baumgarte self = {settings->baumgarte, zd_take_doubles(arena, (size_t)zd_constraints(system))};
    return zd_take_filled(arena, &self, sizeof self);
}

static void stabilize(void *memory, const zd_point *point, const double *integral, double *rhs)
{
    const baumgarte *self = memory;
    const zd_baumgarte *gain = &self->gain;
    const zd_system *system = point->system;
    double *Psi = self->Psi;
    zd_point_velocity_violation(point, Psi);
    for (int k = 0; k < zd_constraints(system); k++) rhs[k] -= gain->alpha * Psi[k];            /* (23) */
    for (int k = 0; k < system->mh; k++) rhs[k] -= gain->beta * point->terms.Phi[k];            /* (23) */
    if (gain->integral > 0)
        for (int k = 0; k < system->mh; k++) rhs[k] -= gain->integral * integral[k];
}

static int extra_size(const zd_system *system, const zd_settings *settings)
{
    return settings->baumgarte.integral > 0 ? system->mh : 0;
}

static void extra_rate(const zd_point *point, double *rate)
{
    for (int k = 0; k < point->system->mh; k++) rate[k] = point->terms.Phi[k];
}

const zd_correction zd_baumgarte_row = {
    .card = {"baumgarte", "Violations are fed back into the acceleration constraints, with gains alpha, beta and integral.", "(23)", 0},
    .every = every,
    .needs = ZD_PHI | ZD_C | ZD_PHI_T,
    .take = take,
    .stabilize = stabilize,
    .extra_size = extra_size,
    .extra_rate = extra_rate,
};
