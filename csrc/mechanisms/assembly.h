/* Assembly without anything unusual: positions in which all joints are closed, as near to a drawing as can be, and velocities that they allow. */
#ifndef ZD_ASSEMBLY_H
#define ZD_ASSEMBLY_H

#include "mechanism.h"

/* p and v (nv,) of a mechanism in absolute coordinates: p comes as drawn, at time 0. `length` m: how large it is. Returns whether they are found;
 * not where rows follow from others, or contradict each other, or what is drawn is too far from closed: whoever tells of that looks more closely. */
int zd_assemble(const zd_mechanism *mechanism, double length, int targets, const zd_target *target, double *p, double *v);

#endif
