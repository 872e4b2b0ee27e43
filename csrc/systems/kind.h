/* What all systems of this folder say of themselves in the same words. */
#ifndef ZD_KIND_H
#define ZD_KIND_H

#include "../include/zerodrift/system.h"

/* The members of a zd_kind that are made from the table `parameter` and the functions `prepare` and `start` of a file, and from the type of
 * the constants that `prepare` fills in, or the number of these. */
#define ZD_PREPARED(constants_type) ZD_PREPARED_DOUBLES(sizeof(constants_type) / sizeof(double))
#define ZD_PREPARED_DOUBLES(count) \
    .parameters = sizeof parameter / sizeof parameter[0], \
    .parameter = parameter, \
    .constants = count, \
    .prepare = prepare, \
    .start = start

#endif
