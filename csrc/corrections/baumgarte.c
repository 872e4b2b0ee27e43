/* Baumgarte's stabilization: the violations are fed back into the right side of (6) and, with an integral gain, also the time
 * integral of the position violation, as the paper's reference [16] proposes. The integral is part of the integrated state.
 */
#include <stdio.h>

#include "../linalg/small.h"
#include "../motion/motion.h"
#include "../point/point.h"

typedef struct gains {
    double alpha, beta, integral;
} gains;

static const zd_parameter parameters[] = {
    {"alpha", "1/s", "Gain of the velocity violation.", 1, ZD_NOT_NEGATIVE, (const double[]){10}},
    {"beta", "1/s^2", "Gain of the position violation. ``beta = alpha**2 / 4`` damps critically.", 1, ZD_NOT_NEGATIVE,
     (const double[]){25}},
    {"integral", "1/s^3", "Gain of the time integral of the position violation, after the paper's reference [16]; it must be less than "
     "``alpha * beta``, or the feedback itself is unstable.", 1, ZD_NOT_NEGATIVE, (const double[]){0}},
};

typedef struct baumgarte {
    gains gain;
    double *Psi;        /* (m,) */
} baumgarte;

static int clash(const void *given, char *message, size_t size)
{
    const gains *gain = given;
    int is_unstable = gain->integral > 0 && !(gain->integral < gain->alpha * gain->beta);
    if (is_unstable)
        snprintf(message, size, "integral must be less than alpha * beta = %g, not %g", gain->alpha * gain->beta, gain->integral);
    return is_unstable;
}

static void *create(zd_arena *arena, const zd_system *system, const void *given)
{
    const gains *gain = given;
    baumgarte self = {*gain, zd_arena_doubles(arena, zd_constraints(system))};
    return zd_arena_copy(arena, &self, sizeof self);
}

static void stabilize(void *memory, const zd_point *point, const double *integral, double *rhs)
{
    const baumgarte *self = memory;
    const gains *gain = &self->gain;
    const zd_system *system = point->system;
    double *Psi = self->Psi;
    zd_point_velocity_violation(point, Psi);
    for (int k = 0; k < zd_constraints(system); k++) rhs[k] -= gain->alpha * Psi[k];            /* (23) */
    for (int k = 0; k < system->mh; k++) rhs[k] -= gain->beta * point->terms.Phi[k];            /* (23) */
    if (gain->integral > 0)
        for (int k = 0; k < system->mh; k++) rhs[k] -= gain->integral * integral[k];
}

static int extra_size(const zd_system *system, const void *given)
{
    const gains *gain = given;
    return gain->integral > 0 ? system->mh : 0;
}

static void extra_rate(const zd_point *point, double *rate)
{
    zd_copy(point->system->mh, point->terms.Phi, rate);
}

const zd_correction zd_baumgarte_row = {
    .card = {
        .name = "baumgarte",
        .summary = "Violations are fed back into the acceleration constraints, with gains alpha, beta and integral.",
        .equations = "(23)",
        .description = "The right side of (6) gets -alpha Psi - beta Phi, so that violations decay as a damped oscillation instead of "
                       "growing. They stay bounded but do not vanish: their size depends on the gains, the step and the motion. Gains that "
                       "are large for the step make an explicit method unstable.",
        .reference = "J. Baumgarte, Stabilization of constraints and integrals of motion in dynamical systems, Computer Methods in "
                     "Applied Mechanics and Engineering 1 (1972) 1-16",
        .parameters = sizeof parameters / sizeof parameters[0],
        .parameter = parameters,
    },
    .clash = clash,
    .needs = ZD_PHI | ZD_C | ZD_PHI_T,
    .create = create,
    .stabilize = stabilize,
    .extra_size = extra_size,
    .extra_rate = extra_rate,
};
