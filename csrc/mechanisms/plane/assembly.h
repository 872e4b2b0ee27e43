/* Assembly without anything unusual: positions in which all joints are closed, as near to a drawing as can be,
 * and velocities that they allow. */
#ifndef ZD_PLANE_ASSEMBLY_H
#define ZD_PLANE_ASSEMBLY_H

#include "assembly_rows.h"

/* p and v (nv,) of a mechanism in absolute coordinates: p comes as drawn, at time 0; places (drives,) <- the coordinates that are driven,
 * where the constants of these relations are 0. Returns whether they are found; not where rows follow from others, or contradict each
 * other, or what is drawn is too far from closed: whoever tells of that looks more closely. */
int zd_assemble(const zd_plane *mechanism, const zd_wanted *wanted, double *p, double *v, double *places);

#endif
