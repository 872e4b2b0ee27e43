/* Consistency of the tables of a spatial mechanism. */
#ifndef ZD_SPACE_CHECK_H
#define ZD_SPACE_CHECK_H

#include "tables.h"

/* Returns 1, or 0 with the violated rule in `message`. */
int zd_space_tables_are_right(const zd_space_tables *tables, char *message, int message_size);

#endif
