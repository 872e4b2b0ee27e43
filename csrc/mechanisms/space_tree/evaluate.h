/* The equations of motion of a tree of bodies in space. */
#ifndef ZD_SPACE_TREE_EVALUATE_H
#define ZD_SPACE_TREE_EVALUATE_H

#include "links.h"

zd_evaluate zd_space_tree_evaluate;

#endif
