/* Angles of joints, which count turns: of joints in the tree they are coordinates of their own,
 * and of the others they follow the rest of p. */
#ifndef ZD_SPACE_TREE_UNWRAPPED_ANGLES_H
#define ZD_SPACE_TREE_UNWRAPPED_ANGLES_H

#include "links.h"

/* The rows of A (nq, nv) of the angles that follow, where bodies are placed; they are zero before. */
void zd_space_tree_write_rates(const zd_space *space, const zd_space_frame *frame, double *A);
/* Brings these angles in p to what the rest of it says, with the turns that they have. */
void zd_space_tree_follow(const void *data, double *p);

#endif
