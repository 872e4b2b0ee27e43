/* Outward: from coordinates to poses, velocities and accelerations. */
#ifndef ZD_SPACE_TREE_MOTION_H
#define ZD_SPACE_TREE_MOTION_H

#include "links.h"

/* frame->pose, and the columns of the tree's Jacobian. */
void zd_tree3_place(const zd_space *space, const zd_frame3 *frame, const double *p);
/* frame->twist, and in frame->bias accelerations where vdot is zero. */
void zd_tree3_move(const zd_space *space, const zd_frame3 *frame, const double *v);
/* Accelerations, to the tree's frame, of one that is moving. */
void zd_tree3_accelerate(const zd_space *space, const zd_frame3 *frame, const double *vdot);
/* A frame after a turn about one of its directions. */
void zd_tree3_turn_axes(zd_axes3 *F, int direction, double angle);
/* How a body is turned. */
zd_rotation zd_tree3_attitude(const zd_tree3 *tree, int body, const double *p);
/* (1) but for angles that follow: ones, and of quaternions half of q times (0, omega). A (nq, nv) is zero before. */
void zd_tree3_write_A(const zd_tree3 *tree, const double *p, double *A);

#endif
