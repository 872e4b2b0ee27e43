/* Mass matrix and inertia forces. */
#ifndef ZD_SPACE_TREE_INERTIA_H
#define ZD_SPACE_TREE_INERTIA_H

#include "links.h"

/* M (nv, nv) of a frame that is placed. */
void zd_space_tree_mass(const zd_space *space, const zd_space_frame *frame, double *M);
/* d (nv,) of one that is moving; frame->wrench is used up. */
void zd_space_tree_bias(const zd_space *space, const zd_space_frame *frame, double *d);
/* Force and torque about the mass centre that give a body its acceleration. */
zd_space_wrench zd_space_tree_need(const zd_space_planned_body *body, const zd_space_pose *pose, const zd_space_twist *twist,
                                   const zd_space_twist *change);

#endif
