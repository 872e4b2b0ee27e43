/* Outward: from coordinates to poses, velocities and accelerations. */
#ifndef ZD_SPACE_TREE_MOTION_H
#define ZD_SPACE_TREE_MOTION_H

#include "links.h"

/* frame->pose, and the columns of the tree's Jacobian. */
void zd_space_tree_place(const zd_space *space, const zd_space_frame *frame, const double *p);
/* frame->twist, and in frame->bias accelerations where vdot is zero. */
void zd_space_tree_move(const zd_space *space, const zd_space_frame *frame, const double *v);
/* Accelerations, to the tree's frame, of one that is moving. */
void zd_space_tree_accelerate(const zd_space *space, const zd_space_frame *frame, const double *vdot);
/* A frame after a turn about one of its directions. */
void zd_space_tree_turn_axes(zd_space_axes *F, int direction, double angle);
/* Attitude of a body. */
zd_rotation zd_space_tree_attitude(const zd_space_tree *tree, int body, const double *p);
/* A of (1), without the rows of dependent angles: ones, and for quaternions half of q times (0, omega). A (nq, nv) must be zero before. */
void zd_space_tree_write_A(const zd_space_tree *tree, const double *p, double *A);

#endif
