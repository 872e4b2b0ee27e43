/* Quick check of the pivots of the closed-form path at the end of a step: paths/choose.c sets the bounds. */
#ifndef ZD_PIVOTS_H
#define ZD_PIVOTS_H

#include <string.h>

#include "motion.h"

/* True if all pivots are within their ranges; the next step then uses the same elimination order, the first. Bits are compared as integers,
 * which are ordered as the magnitudes are, because the floating-point units are busy with the next step. */
ZD_INLINE int zd_pivots_stay(zd_path *path)
{
    for (int k = 0; k < path->ranges; k++) {
        uint64_t bits;
        memcpy(&bits, path->pivots + k, sizeof bits);
        if (bits - path->range[k].least > path->range[k].width) return 0;
    }
    path->was_taken = path->continues = 1;
    return 1;
}

#endif
