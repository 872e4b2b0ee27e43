/* Correction of the energy by scaling the velocities, after the constraints have been corrected:
 *
 *     v <- sqrt(1 - Psi_E / T) v      (29)
 *
 * With moving constraints only v - vn may be scaled, where vn = solve(0, -Phi_t) is the motion they enforce. It is M-orthogonal to
 * v - vn, so T is the sum of the kinetic energies of both, and that of v - vn takes the place of T.
 *
 * Where T is small (a turning point) no bounded factor removes the error: such a step is not corrected, but counted and marked in
 * the record.
 */
#include <math.h>

#include "../constraints/limits.h"
#include "../motion/motion.h"
#include "../point/point.h"

static const double LARGEST_SHARE = 0.5;    /* largest correction relative to T: the factor is then between 0.7 and 1.3 */
static const double ENERGY_ROUNDING = 8 * 0x1p-52; /* violation relative to the energies below which it is rounding error */

typedef struct given_energy {
    double every;
} given_energy;

static const zd_parameter parameters[] = {
    {"every", "", "Steps between corrections; the last step is always corrected.", 1, ZD_COUNT, (const double[]){1}},
};

typedef struct energy {
    double *enforced;       /* (nv,): vn; zero where no constraint moves */
    double *scaled;         /* (nv,) */
} energy;

static int every(const void *given)
{
    return (int)((const given_energy *)given)->every;
}

static void *create(zd_arena *arena, const zd_system *system, const void *given)
{
    (void)given;
    energy self = {zd_arena_doubles(arena, system->nv), zd_arena_doubles(arena, system->nv)};
    return zd_arena_copy(arena, &self, sizeof self);
}

/* vn, and the kinetic energy of v - vn from that of v */
static int split(energy *self, zd_motion *motion, double *kinetic)
{
    zd_point *point = motion->point;
    int n = motion->system.nv, status = zd_point_need(point, ZD_PHI_T);
    if (status || !point->terms.Phi_t) return status;
    status = zd_motion_factor(motion);
    if (status) return status;
    for (int k = 0; k < zd_constraints(&motion->system); k++) point->rhs[k] = -point->terms.Phi_t[k];
    status = zd_limits_replace(point, ZD_LIMIT_ENFORCED, point->rhs);
    if (status) return status;
    zd_motion_solve(motion, NULL, point->rhs, self->enforced, NULL);
    double *momentum = self->scaled;
    zd_times_M(point, point->terms.M, self->enforced, momentum);
    for (int i = 0; i < n; i++) *kinetic -= 0.5 * self->enforced[i] * momentum[i];
    return ZD_DONE;
}

static void count_skipped(zd_motion *motion)
{
    motion->statistics.energy_skipped++;
    motion->tally->energy_skipped++;
}

static int after_step(void *memory, zd_motion *motion)
{
    energy *self = memory;
    double violation, kinetic, *scaled = self->scaled;
    int status = zd_motion_energy_violation(motion, &violation, &kinetic);
    double rounding = ENERGY_ROUNDING * (kinetic + fabs(zd_point_potential(motion->point)) + fabs(motion->balance.initial));
    if (!status) status = split(self, motion, &kinetic);
    if (status) return status;
    if (!(fabs(violation) <= LARGEST_SHARE * kinetic)) {
        if (!(fabs(violation) <= rounding)) count_skipped(motion);
        return ZD_DONE;
    }
    if (violation == 0) return ZD_DONE;
    double factor = sqrt(1 - violation / kinetic);
    for (int i = 0; i < motion->system.nv; i++)
        scaled[i] = self->enforced[i] + factor * (motion->point->v[i] - self->enforced[i]);    /* (29) */
    zd_point_move_velocity(motion->point, scaled);
    motion->statistics.energy_corrections++;
    motion->statistics.energy_corrected = fmax(motion->statistics.energy_corrected, fabs(violation));
    return ZD_DONE;
}

const zd_correction zd_energy_row = {
    .card = {
        .name = "energy",
        .summary = "Velocities are scaled so that the energy balance holds.",
        .equations = "(28), (29)",
        .description = "After the correction of the constraints, the part of the velocities that moving constraints do not prescribe is "
                       "scaled by one factor, such that kinetic and potential energy equal the initial energy and the work done since. Near "
                       "a turning point the kinetic energy is too small for this; such a step is not corrected, and counted. A closed "
                       "energy balance does not imply that the phase of the motion is right.",
        .reference = "W. Blajer, Elimination of constraint violation and accuracy aspects in numerical simulation of multibody systems, "
                     "Multibody System Dynamics 7 (2002) 265-284, section 3.2",
        .parameters = sizeof parameters / sizeof parameters[0],
        .parameter = parameters,
    },
    .requires = ZD_POTENTIAL,
    .every = every,
    .create = create,
    .after_step = after_step,
};
