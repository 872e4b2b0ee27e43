/* Directional derivatives of the residuals of a system, at constant vdot and lambda,
 *
 *     r = M vdot + d - f + C^T lambda     (2)        Psi = C v + Phi_t    (5)
 *     s = C vdot - xi                     (6)        pdot = A v           (1)
 *
 * and of the power in (28), lambda^T Phi_t included. One solve with the leading matrix gives from those of r and s the derivatives of
 * accelerations and multipliers, in jacobian.c for implicit integrators, and for linearization, equilibrium and comparisons.
 */
#pragma once

#include "../point/point.h"

enum zd_accuracy {
    ZD_FOR_ITERATIONS,      /* differences of first order, one evaluation for each direction: 1e-8 */
    ZD_CENTRAL,             /* differences of second order, with steps that leave less rounding: 1e-8 */
    ZD_ACCURATE             /* differences of eighth order, compared with those of sixth: 1e-12 */
};

/* Residuals at a state, and memory for their differences. */
typedef struct zd_residual_state {
    zd_point *varied;       /* point besides that of the state, at which residuals are evaluated */
    int parts, width;       /* requested parts, ZD_RESIDUAL_..., and the number of their entries, which follow one another in this order: */
    int s_at, Psi_at, pdot_at, power_at;    /* offsets of the parts after r */
    int needs;              /* terms that the requested residuals need besides A */
    zd_point *point;        /* the state */
    const double *vdot, *lambda;    /* (nv,), (m,): there */
    int moves;              /* true if an entry of vdot is not zero */
    int knows_here;         /* true if `here` has been computed */
    double *here, *there;   /* (width,): residuals at the state, and at another */
    double *x;              /* (nq + nv,): another state */
    double *sums;           /* (3, width): differences of eighth, sixth and fourth order; NULL: without ZD_ACCURATE */
    double *scratch;        /* work array of the system's own derivatives */
} zd_residual_state;

/* Memory for all parts. */
zd_residual_state zd_residual_state_create(zd_arena *arena, const zd_system *system, zd_statistics *statistics, enum zd_accuracy accuracy);
/* The parts to be differentiated at this point, which must remain there, as the arrays. */
void zd_residual_state_begin(zd_residual_state *self, int parts, zd_point *point, const double *vdot, const double *lambda);
/* to (width,) <- derivatives along a direction: the system's own where it has them, else by differences. `step`: for iterations, the
 * increment along it; otherwise the inverse of its size in characteristic scales. */
int zd_residual_derivatives(zd_residual_state *self, const zd_direction *direction, double step, enum zd_accuracy accuracy, double *to);
