/* Which rows of C count at a point: all of them, an independent choice, or one in which limits stand for rows that are lost.
 *
 * That all count costs an ordinary point one cheap look: at the products of two rows; at what a formulation finds anyway as it orthogonalizes
 * them; or at how little they have changed since a closer look. Only where it does not tell, memory for more is taken.
 */
#ifndef ZD_ROWS_H
#define ZD_ROWS_H

#include "rank.h"

enum { ZD_FEW_ROWS = 2 };       /* so many are looked at themselves */

/* Which rows count at the point, into point->rows, point->C. */
int zd_rows_find(zd_point *point);
/* Whether the rows that count there were chosen before: then they are chosen anew where they are found next. */
int zd_rows_give_up_kept(zd_point *point);
/* The same again, as the velocity has changed, along which limits are taken. */
int zd_rows_find_again(zd_point *point);

/* For formulations that tell by themselves whether all rows count: whether none is nearly nothing at the point, and that all do. */
int zd_rows_are_long(const zd_point *point);
void zd_rows_use_all(zd_point *point);

#endif
