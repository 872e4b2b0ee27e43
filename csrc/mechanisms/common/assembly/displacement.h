/* Displacements (nv,): places move, and bodies turn about an axis of their own by the length of a rotation vector.
 *
 * Plain declarations only: CFFI parses this text. SI units, radians.
 */
#ifndef ZD_DISPLACEMENT_H
#define ZD_DISPLACEMENT_H

#include "../../../include/zerodrift/system.h"

/* Absolute coordinates: those of M are rates of p, except that quaternions (scalar first) change by angular velocities in body axes.
 * to (nq,) <- p after the displacement x; not p itself. Dependent angles stay on their turns. */
void zd_displace(const zd_system *system, const double *p, const double *x, double *to);
/* x (nv,) <- displacement from `other` to p, by the shorter rotation of each body */
void zd_displacement(const zd_system *system, const double *p, const double *other, double *x);

#endif
