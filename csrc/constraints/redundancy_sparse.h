/* Redundant rows, of a declared structure with many. */
#ifndef ZD_REDUNDANCY_SPARSE_H
#define ZD_REDUNDANCY_SPARSE_H

#include "rank.h"

/* Notes them in point->rank; C is known there. ZD_CONTRADICTION: there is no acceleration that satisfies them as well as the others;
 * ZD_BIFURCATION: one of them follows from the others in this position only. */
int zd_redundancy_sparse_find(zd_point *point);

#endif
