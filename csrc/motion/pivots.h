/* Whether the pivots of the direct road are what they were where the step began: see direct.c, which has the bounds. */
#ifndef ZD_PIVOTS_H
#define ZD_PIVOTS_H

#include "motion.h"

#define ZD_LARGE_PIVOT 0x1p-3   /* the first order of elimination with such pivots is taken */
#define ZD_SHRUNK_PIVOT 0x1p-4  /* within a step: what lies between its ends is then no longer known from them */

/* Then the next step may begin with the same order, the first, and where it begins is kept. Entries of `pivots`, `before`, `scale` beyond those
 * of the order are one. */
ZD_INLINE int zd_pivots_stay(const int n, zd_road *road)
{
    const double *x = road->pivots, *x0 = road->before, *scale = road->scale_of_order;
    int stay = 1;
    for (int k = 0; k < n; k++) stay &= (x[k] * x0[k] >= ZD_SHRUNK_PIVOT * x0[k] * x0[k]) & (fabs(x[k]) * scale[k] >= ZD_LARGE_PIVOT);
    if (!stay || road->order != road->direct->order) return 0;
    for (int k = 0; k < n; k++) road->before[k] = x[k];
    road->was_taken = road->continues = 1;
    return 1;
}

#endif
