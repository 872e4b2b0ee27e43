/* Names of constraints in messages. */
#ifndef ZD_ROW_NAME_H
#define ZD_ROW_NAME_H

#include "../zerodrift.h"

enum { ZD_ROW_NAME = 64 };      /* size of a name, characters */

/* Index of the constraint, with its name if the system provides one: "3", "3 'B.y'". Returns `to`. */
const char *zd_name_row(const zd_system *system, int row, char to[ZD_ROW_NAME]);

#endif
