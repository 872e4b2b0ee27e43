/* Whether the pivots of the direct road are what they were where the step began: see direct.c, which has the bounds. */
#ifndef ZD_PIVOTS_H
#define ZD_PIVOTS_H

#include <string.h>

#include "motion.h"

/* Then the next step may begin with the same order, the first. Compared are their bits, which lie as the sizes do: what computes is busy
 * with the step that follows. */
ZD_INLINE int zd_pivots_stay(zd_road *road)
{
    for (int k = 0; k < road->ranges; k++) {
        uint64_t bits;
        memcpy(&bits, road->pivots + k, sizeof bits);
        if (bits - road->range[k].least > road->range[k].width) return 0;
    }
    road->was_taken = road->continues = 1;
    return 1;
}

#endif
