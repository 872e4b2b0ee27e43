/* Redundant constraints of a declared structure with many constraints. */
#ifndef ZD_REDUNDANCY_SPARSE_H
#define ZD_REDUNDANCY_SPARSE_H

#include "rank.h"

/* Records them in point->rank; C is known there. ZD_CONTRADICTION: no acceleration satisfies them together with the others;
 * ZD_BIFURCATION: one of them is dependent in this position only. */
int zd_redundancy_sparse_find(zd_point *point);

#endif
