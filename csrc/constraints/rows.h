/* Selection of the independent constraints at a point: all of them, an independent subset, or one in which limits replace constraints
 * that are lost at a bifurcation.
 *
 * At an ordinary point a quick check shows that all are independent: the products of two rows; the pivots that a formulation computes
 * anyway; or the change since the last full check. Memory for more is allocated only if this is inconclusive.
 */
#ifndef ZD_ROWS_H
#define ZD_ROWS_H

#include "rank.h"

enum { ZD_FEW_ROWS = 2 };       /* largest number of constraints checked by their products */

/* Finds the independent constraints at the point; sets point->rows, point->C. */
int zd_rows_find(zd_point *point);
/* Discards a selection kept from an earlier point, so that the next zd_rows_find() selects anew; returns 0 if there was none. */
int zd_rows_give_up_kept(zd_point *point);
/* Selects again after a change of the velocity, along which limits are taken. */
int zd_rows_find_again(zd_point *point);

/* For formulations that check independence themselves: true if no row has shrunk to nearly zero at the point; selection of all
 * constraints. */
int zd_rows_are_long(const zd_point *point);
void zd_rows_use_all(zd_point *point);

#endif
