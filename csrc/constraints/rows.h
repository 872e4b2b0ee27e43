/* Which rows of C count at a point: all of them, an independent choice, or one in which limits stand for rows that are lost. */
#ifndef ZD_ROWS_H
#define ZD_ROWS_H

#include "rank.h"

/* `may_be_deficient`: whether the run goes on where fewer rows are independent than elsewhere; else that is ZD_BIFURCATION. */
zd_rank *zd_rows_take(zd_arena *arena, const zd_system *system, int may_be_deficient);
/* Which rows count at the point, into point->rows, point->C. */
int zd_rows_find(zd_point *point);
/* The same again, as the velocity has changed, along which limits are taken. */
int zd_rows_find_again(zd_point *point);

#endif
