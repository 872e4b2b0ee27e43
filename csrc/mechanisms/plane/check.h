/* Consistency of the tables of a planar mechanism. */
#ifndef ZD_PLANE_CHECK_H
#define ZD_PLANE_CHECK_H

#include "tables.h"

/* Returns 1, or 0 with the violated rule in `message`. */
int zd_plane_tables_are_right(const zd_plane_tables *tables, char *message, int message_size);

#endif
