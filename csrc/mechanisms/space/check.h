/* Consistency of the tables of a spatial mechanism. */
#ifndef ZD_SPACE_CHECK_H
#define ZD_SPACE_CHECK_H

#include "tables.h"

/* Returns whether they are right; if not, says where in `message`. */
int zd_space_tables_are_right(const zd_space_tables *tables, char *message, int message_size);

#endif
