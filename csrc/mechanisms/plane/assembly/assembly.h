/* Assembly without anything unusual: positions in which all joints are closed, as near to a drawing as can be,
 * and velocities that they allow. */
#ifndef ZD_PLANE_ASSEMBLY_H
#define ZD_PLANE_ASSEMBLY_H

#include "assembly_rows.h"

/* Position assembly and consistent velocities. p (nv,), absolute coordinates at time 0, is the reference configuration on entry and
 * assembled on return; v (nv,) is computed; places (drives,) <- values of the driven coordinates, where the constants of these relations
 * are 0. Returns 0 if no assembly is found: rows are redundant or contradictory, or the reference configuration is too far from closed.
 * The caller then diagnoses the reason. */
int zd_assemble(const zd_plane *mechanism, const zd_wanted *wanted, double *p, double *v, double *places);

#endif
