/* How large a mechanism is. */
#ifndef ZD_MECHANISM_LENGTH_H
#define ZD_MECHANISM_LENGTH_H

#include "mechanism.h"

double zd_tables_length(const zd_tables *tables);     /* m */

#endif
