/* What becomes of dependent rows at the start. */
#ifndef ZD_REDUNDANCY_H
#define ZD_REDUNDANCY_H

#include "rank.h"

/* Comes first, so that rows can be found. */
int zd_redundancy_prepare(zd_point *point);
/* Finds the rank at the start, and from (6) whether rows that follow from others contradict them, do so wherever the system goes (they
 * are redundant), or only here (a bifurcation). A system without (6) is not asked. */
int zd_redundancy_find(zd_point *point, enum zd_on_singular on_singular);

#endif
