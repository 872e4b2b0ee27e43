/* Inward: what wrenches on bodies do to the velocities, and what of them joints have to pass on. */
#ifndef ZD_SPACE_TREE_INWARD_H
#define ZD_SPACE_TREE_INWARD_H

#include "links.h"

/* row (nv,) += what `scale` times a unit force along a gauge does. Of bodies that both of its bodies hang on that is nothing, to the last
 * bit, unless the force acts on one body alone, or particles between them pass no torque on. */
void zd_tree3_act(const zd_space *space, const zd_frame3 *frame, const zd_space_gauge *gauge, double scale, const zd_reading3 *reading,
                  double *row);
/* to (nv,) <- what the wrenches on all bodies, frame->wrench, do; they are used up. */
void zd_tree3_gather(const zd_space *space, const zd_frame3 *frame, double *to);
/* frame->wrench <- what has to come to each body from the one that it hangs on, where it is what each body needs by itself. */
void zd_tree3_transmit(const zd_space *space, const zd_frame3 *frame);
/* What a wrench on a body is for the one that it hangs on; a particle passes no torque on. */
zd_wrench3 zd_tree3_pass(const zd_link3 *link, const zd_pose3 *pose, int body, zd_wrench3 what);

#endif
