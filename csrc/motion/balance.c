/* The energy balance, (28). */
#include <math.h>

#include "../point/point.h"
#include "motion.h"

int zd_has_energy(const zd_system *system)
{
    return (system->provides & ZD_POTENTIAL) != 0;
}

int zd_has_input(const zd_system *system)
{
    return zd_has_energy(system) && (system->provides & (ZD_POWER | ZD_PHI_T));
}

/* Power put in besides V: by forces, and by moving constraints, whose force -C^T lambda does work because C v = -Phi_t. */
double zd_motion_power(const zd_motion *motion)
{
    const zd_point *point = motion->point;
    double sum = point->terms.power ? *point->terms.power : 0;
    if (point->terms.Phi_t) zd_rank_find_multipliers(point);
    if (point->terms.Phi_t)
        for (int k = 0; k < zd_constraints(point->system); k++) sum += point->lambda[k] * point->terms.Phi_t[k];
    return sum;
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

int zd_motion_start_energy(zd_motion *motion)
{
    double kinetic;
    if (!zd_has_energy(&motion->system)) return ZD_DONE;
    return zd_motion_energy_violation(motion, &motion->balance.initial, &kinetic);     /* E0 of (28), which is 0 here */
}
