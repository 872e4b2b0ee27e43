/* What goes through joints of space. */
#ifndef ZD_SPACE_REACTIONS_H
#define ZD_SPACE_REACTIONS_H

#include "plan.h"

/* What the first body of a joint does to the second: a force at the joint's point of the second body, with the torque about it, in the
 * drawing's axes, from a frame that is placed and moving. With the joint's drives and damping. Returns ZD_DONE or ZD_CALLBACK. */
int zd_space_joint_reaction(const zd_space *self, const zd_space_frame *frame, int joint, double t, const double *vdot, const double *lambda,
                            zd_space_wrench *reaction);

#endif
