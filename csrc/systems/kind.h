/* Members of zd_kind that all systems of this folder initialize alike. */
#ifndef ZD_KIND_H
#define ZD_KIND_H

#include "../include/zerodrift/system.h"

/* Initializers from the table `parameter` and the functions `prepare` and `start` of a file, and from the type of the constants that
 * `prepare` computes, or their number. */
#define ZD_PREPARED(constants_type) ZD_PREPARED_DOUBLES(sizeof(constants_type) / sizeof(double))
#define ZD_PREPARED_DOUBLES(count) \
    .parameters = sizeof parameter / sizeof parameter[0], \
    .parameter = parameter, \
    .constants = count, \
    .prepare = prepare, \
    .start = start

#endif
