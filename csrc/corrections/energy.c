/* The energy error is taken out of the velocities by scaling them, once the constraints hold:
 *
 *     v <- sqrt(1 - Psi_E / T) v      (29)
 *
 * Where constraints move, only what v has besides the motion they enforce may be scaled. With vn = solve(0, -Phi_t), which is
 * M-orthogonal to it, T splits into that of vn and that of v - vn, and the latter takes the place of T.
 *
 * Where T is small (a turning point) no bounded factor removes the error: such a step is left alone, counted, and told from the
 * others in the record.
 */
#include "../core.h"
#include "../linalg/small.h"
#include "../constraints/rank.h"

static const double LARGEST_SHARE = 0.5;    /* of T that a correction may be: then the factor is between 0.7 and 1.3 */
static const double ROUNDING = 8 * 0x1p-52;     /* of the energies: a violation so small needs no correction */

typedef struct energy {
    double *enforced;       /* (nv,): vn; zero where no constraint moves */
    double *scaled;         /* (nv,) */
} energy;

static int enabled(const zd_settings *settings)
{
    return settings->energy.every > 0;
}

static void *take(zd_arena *arena, const zd_system *system, const zd_settings *settings)
{
    (void)settings;
    energy self = {zd_take_doubles(arena, (size_t)system->nv), zd_take_doubles(arena, (size_t)system->nv)};
    return zd_take_filled(arena, &self, sizeof self);
}

/* vn, and the kinetic energy of v - vn from that of v */
static int split(energy *self, zd_run *run, double *kinetic)
{
    zd_point *point = run->point;
    int n = run->system.nv, status = zd_point_need(point, ZD_PHI_T);
    if (status || !point->terms.Phi_t) return status;
    status = zd_run_factor(run);
    if (status) return status;
    for (int k = 0; k < zd_constraints(&run->system); k++) point->rhs[k] = -point->terms.Phi_t[k];
    status = zd_rank_replace(point, ZD_LIMIT_ENFORCED, point->rhs);
    if (status) return status;
    zd_run_solve(run, NULL, point->rhs, self->enforced, NULL);
    for (int i = 0; i < n; i++) *kinetic -= 0.5 * self->enforced[i] * zd_dot(n, point->terms.M + i * n, self->enforced);
    return ZD_DONE;
}

static void count_skipped(zd_run *run)
{
    run->statistics.energy_skipped++;
    run->energy_skipped++;
}

static int after_step(void *memory, zd_run *run)
{
    energy *self = memory;
    double violation, kinetic, *scaled = self->scaled;
    if (!zd_run_is_due(run, run->settings.energy.every)) return ZD_DONE;
    int status = zd_run_energy_violation(run, &violation, &kinetic);
    double rounding = ROUNDING * (kinetic + fabs(zd_point_potential(run->point)) + fabs(run->energy0));
    if (!status) status = split(self, run, &kinetic);
    if (status) return status;
    if (!(fabs(violation) <= LARGEST_SHARE * kinetic)) {
        if (!(fabs(violation) <= rounding)) count_skipped(run);
        return ZD_DONE;
    }
    if (violation == 0) return ZD_DONE;
    double factor = sqrt(1 - violation / kinetic);
    for (int i = 0; i < run->system.nv; i++)
        scaled[i] = self->enforced[i] + factor * (run->point->v[i] - self->enforced[i]);    /* (29) */
    zd_point_move_velocity(run->point, scaled);
    run->statistics.energy_corrections++;
    run->statistics.energy_corrected = fmax(run->statistics.energy_corrected, fabs(violation));
    return ZD_DONE;
}

const zd_correction zd_energy_row = {
    .card = {"energy", "Velocities are scaled so that the energy balance holds.", "(28), (29)", 0},
    .enabled = enabled,
    .take = take,
    .after_step = after_step,
};
