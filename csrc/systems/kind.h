/* Members of zd_kind that all systems of this folder initialize alike. */
#pragma once

#include "../include/zerodrift/system.h"

/* Initializers from the table `parameter` and the functions `prepare` and `start` of a file, and from the number of the constants that
 * `prepare` computes. */
#define ZD_PREPARED(count) \
    .parameters = sizeof parameter / sizeof parameter[0], \
    .parameter = parameter, \
    .constants = count, \
    .prepare = prepare, \
    .start = start
