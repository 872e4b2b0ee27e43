/* Whether rows of C might be dependent, where its structure is declared. */
#ifndef ZD_PACKED_ROWS_H
#define ZD_PACKED_ROWS_H

#include "rank.h"

/* In the plain metric, and in the order of the rows: whether any might be one of those before it. */
int zd_packed_rows_are_doubtful(zd_point *point);

#endif
