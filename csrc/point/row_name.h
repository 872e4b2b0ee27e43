/* What messages call a row of C. */
#ifndef ZD_ROW_NAME_H
#define ZD_ROW_NAME_H

#include "../zerodrift.h"

enum { ZD_ROW_NAME = 64 };      /* characters that there is room for */

/* Its number, and where the system has a name for it, that: "3", "3 'B.y'". Returns `to`. */
const char *zd_name_row(const zd_system *system, int row, char to[ZD_ROW_NAME]);

#endif
