/* The mass matrix, and what inertia asks for. */
#ifndef ZD_SPACE_TREE_INERTIA_H
#define ZD_SPACE_TREE_INERTIA_H

#include "links.h"

/* M (nv, nv) of a frame that is placed. */
void zd_tree3_mass(const zd_space *space, const zd_frame3 *frame, double *M);
/* d (nv,) of one that is moving; frame->wrench is used up. */
void zd_tree3_bias(const zd_space *space, const zd_frame3 *frame, double *d);
/* What a body needs for its accelerations: a force, and a torque about its mass centre. */
zd_wrench3 zd_tree3_need(const zd_body3 *body, const zd_pose3 *pose, const zd_twist3 *twist, const zd_twist3 *change);

#endif
