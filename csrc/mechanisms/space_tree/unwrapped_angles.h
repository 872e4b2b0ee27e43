/* Unwrapped joint angles: independent coordinates of inboard joints, dependent coordinates of all other joints. */
#ifndef ZD_SPACE_TREE_UNWRAPPED_ANGLES_H
#define ZD_SPACE_TREE_UNWRAPPED_ANGLES_H

#include "links.h"

/* Rows of A (nq, nv) of the dependent angles, from placed bodies; they must be zero before. */
void zd_space_tree_write_rates(const zd_space *space, const zd_space_frame *frame, double *A);
/* Updates the dependent angles in p, keeping their full turns. */
void zd_space_tree_follow(const void *data, double *p);

#endif
