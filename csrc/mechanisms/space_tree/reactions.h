/* Reactions of inboard joints. */
#ifndef ZD_SPACE_TREE_REACTIONS_H
#define ZD_SPACE_TREE_REACTIONS_H

#include "links.h"

/* See zd_carrying. */
int zd_space_tree_reaction(const zd_space *space, const zd_space_frame *frame, int joint, zd_vector3 point,
                           const zd_measured_state *at, zd_space_wrench *reaction);

#endif
