/* Whether the pivots of the direct road are what they were where the step began: see direct.c, which has the bounds. */
#ifndef ZD_PIVOTS_H
#define ZD_PIVOTS_H

#include <string.h>

#include "motion.h"

/* Then the next step may begin with the same order, the first. Compared are their bits, which lie as the sizes do: what computes is busy
 * with the step that follows. */
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
