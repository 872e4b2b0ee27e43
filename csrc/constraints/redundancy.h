/* Classification of dependent constraints at the start. */
#ifndef ZD_REDUNDANCY_H
#define ZD_REDUNDANCY_H

#include "rank.h"

/* Measures the constraints; must precede the first selection. */
int zd_redundancy_prepare(zd_point *point);
/* Finds the rank at the start, and from (6) whether dependent constraints contradict the others, are redundant (dependent everywhere),
 * or are dependent only here (a bifurcation). If the system does not provide xi of (6), they are not classified. */
int zd_redundancy_find(zd_point *point, enum zd_on_singular on_singular);

#endif
