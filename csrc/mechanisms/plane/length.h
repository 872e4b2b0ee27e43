/* Characteristic length of a mechanism. */
#ifndef ZD_PLANE_LENGTH_H
#define ZD_PLANE_LENGTH_H

#include "tables.h"

double zd_plane_tables_length(const zd_plane_tables *tables);     /* m */

#endif
