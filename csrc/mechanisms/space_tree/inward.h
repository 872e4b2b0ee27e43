/* Inward recursion: generalized forces of wrenches on bodies, and the wrenches that joints transmit. */
#ifndef ZD_SPACE_TREE_INWARD_H
#define ZD_SPACE_TREE_INWARD_H

#include "links.h"

/* row (nv,) += scale times the generalized force of a unit force along a marker quantity. It is exactly zero for common ancestors of both
 * bodies, unless the force acts on one body alone, or a particle between them transmits no torque. */
void zd_space_tree_act(const zd_space *space, const zd_space_frame *frame, const zd_space_quantity *quantity, double scale,
                       const zd_space_reading *reading,
                  double *row);
/* to (nv,) <- generalized forces of the wrenches on all bodies, frame->wrench, which is overwritten. */
void zd_space_tree_gather(const zd_space *space, const zd_space_frame *frame, double *to);
/* frame->wrench: required wrench on each body individually -> wrench transmitted to each body from its parent. */
void zd_space_tree_transmit(const zd_space *space, const zd_space_frame *frame);
/* Wrench on the parent that is transmitted from a wrench on a body; a particle transmits no torque. */
zd_space_wrench zd_space_tree_pass(const zd_space_link *link, const zd_space_pose *pose, int body, zd_space_wrench what);

#endif
