/* Whether tables of a mechanism contradict themselves. */
#ifndef ZD_MECHANISM_CHECK_H
#define ZD_MECHANISM_CHECK_H

#include "mechanism.h"

/* Returns whether they are right; if not, says where in `message`. */
int zd_tables_are_right(const zd_tables *tables, char *message, int message_size);

#endif
