/* Tree of inboard joints of a block in the plane, and the loops that its other joints close. */
#ifndef ZD_BLOCK_LOOPS_H
#define ZD_BLOCK_LOOPS_H

#include "layout.h"

/* Inboard joint of a body, numbered from 1; -1: it is free. */
int zd_block_inboard(const zd_block_layout *layout, int body);
/* True if a body of the block has an inboard joint. */
int zd_block_has_tree(const zd_block_layout *layout);
/* inboard (bodies,) <- inboard joints, -1 for free bodies, of the tree that grows from the ground by the joint of fewest coordinates, and
 * among these by the one nearest to the ground; `distance` (bodies + 1,) is scratch. */
void zd_block_grow_tree(const zd_block_layout *layout, int *inboard, int *distance);
/* Writes the bodies and joints of the loop that a joint closes, "the loop of ground, crank, through A, B". Returns the length of the text.
 * `is_on_way` (bodies + joints + 1,) is scratch. */
int zd_block_name_loop(const zd_block_layout *layout, int joint, int *is_on_way, char *to, int size);

const char *zd_block_joint_name(const zd_block_layout *layout, int joint);

#endif
