/* Reactions of joints in space. */
#ifndef ZD_SPACE_REACTIONS_H
#define ZD_SPACE_REACTIONS_H

#include "../plan.h"

/* Reaction of a joint: force of the first body on the second at the joint's point of the second body, and torque about that point, in
 * global axes, from a frame that is placed and moving. Includes the joint's drives and damping. Returns ZD_DONE or ZD_CALLBACK. */
int zd_space_joint_reaction(const zd_space *self, const zd_space_frame *frame, int joint, const zd_measured_state *at,
                            zd_space_wrench *reaction);

#endif
