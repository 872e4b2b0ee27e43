/* Inward: what wrenches on bodies do to the velocities, and what of them joints have to pass on. */
#ifndef ZD_SPACE_TREE_INWARD_H
#define ZD_SPACE_TREE_INWARD_H

#include "links.h"

/* row (nv,) += what `scale` times a unit force along a gauge does. Of bodies that both of its bodies hang on that is nothing, to the last
 * bit, unless the force acts on one body alone, or particles between them pass no torque on. */
void zd_space_tree_act(const zd_space *space, const zd_space_frame *frame, const zd_space_gauge *gauge, double scale, const zd_space_reading *reading,
                  double *row);
/* to (nv,) <- what the wrenches on all bodies, frame->wrench, do; they are used up. */
void zd_space_tree_gather(const zd_space *space, const zd_space_frame *frame, double *to);
/* frame->wrench <- what has to come to each body from the one that it hangs on, where it is what each body needs by itself. */
void zd_space_tree_transmit(const zd_space *space, const zd_space_frame *frame);
/* What a wrench on a body is for the one that it hangs on; a particle passes no torque on. */
zd_space_wrench zd_space_tree_pass(const zd_space_link *link, const zd_space_pose *pose, int body, zd_space_wrench what);

#endif
