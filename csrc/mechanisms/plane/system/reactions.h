/* Reactions of joints. */
#ifndef ZD_PLANE_REACTIONS_H
#define ZD_PLANE_REACTIONS_H

#include "../../common/output_spec.h"
#include "../plan.h"

/* Reaction of a joint: force of the first body on the second at the joint's point of the second body, and torque about that point, from a
 * frame that is placed and moving. Includes the joint's drives and damping. Returns ZD_DONE or ZD_CALLBACK. */
int zd_plane_joint_reaction(const zd_plane *self, const zd_plane_frame *frame, int joint, const zd_measured_state *at,
                            zd_plane_wrench *reaction);

#endif
