/* The energy error is taken out of the velocities by scaling them, once the constraints hold:
 *
 *     v <- sqrt(1 - Psi_E / T) v      (29)
 *
 * Where T is small (a turning point) no bounded factor does that: such a step is left alone and counted.
 */
#include "../core.h"

static const double LARGEST_SHARE = 0.5;    /* of T that a correction may be: then the factor is between 0.7 and 1.3 */
static const double ROUNDING = 8 * 0x1p-52;     /* of the energies: a violation so small needs no correction */

static int enabled(const zd_settings *settings)
{
    return settings->energy.every > 0;
}

static void *take(zd_arena *arena, const zd_system *system)
{
    return zd_take_doubles(arena, (size_t)system->nv);
}

static int after_step(void *memory, zd_run *run)
{
    double *scaled = memory, violation, kinetic;
    if (run->step % run->settings.energy.every && run->step != run->steps) return ZD_DONE;
    int status = zd_run_energy_violation(run, &violation, &kinetic);
    if (status) return status;
    if (!(fabs(violation) <= LARGEST_SHARE * kinetic)) {
        double rounding = ROUNDING * (kinetic + fabs(zd_point_potential(run->point)) + fabs(run->energy0));
        if (!(fabs(violation) <= rounding)) run->statistics.energy_skipped++;
        return ZD_DONE;
    }
    if (violation == 0) return ZD_DONE;
    double factor = sqrt(1 - violation / kinetic);
    for (int i = 0; i < run->system.nv; i++) scaled[i] = factor * run->point->v[i];     /* (29) */
    zd_point_move_velocity(run->point, scaled);
    run->statistics.energy_corrections++;
    return ZD_DONE;
}

const zd_correction zd_energy_row = {
    .card = {"energy", "Velocities are scaled so that the energy balance holds.", "(28), (29)", 0},
    .enabled = enabled,
    .take = take,
    .after_step = after_step,
};
