/* Rows that follow from others at the start, of a declared structure with many. */
#ifndef ZD_SURPLUS_H
#define ZD_SURPLUS_H

#include "rank.h"

/* Notes them in point->rank; C is known there. */
int zd_surplus_find(zd_point *point);
/* Whether the accelerations at the point satisfy these rows, too: else that is ZD_CONTRADICTION. */
int zd_surplus_check(zd_point *point);

#endif
