/* Checks of pivots, and the inverse of a block of two rows. */
#ifndef ZD_PIVOT_H
#define ZD_PIVOT_H

#include "../small.h"
#include "blocks.h"

/* True if this pivot is positive; updates the smallest relative pivot. Ratios are compared by products, to avoid divisions. */
ZD_INLINE int zd_judge_pivot(zd_pivots *pivots, int row, double pivot, double diagonal, double rounding)
{
    if (!(pivot > rounding * diagonal) || !(pivot < INFINITY)) {
        if (pivots->failed < 0) pivots->failed = row;
        return 0;
    }
    if (pivot * pivots->diagonal < pivots->pivot * diagonal) pivots->smallest = row, pivots->pivot = pivot, pivots->diagonal = diagonal;
    return 1;
}

typedef struct zd_inverse_of_two {  /* symmetric inverse, in registers: these entries times the scale; scale 0: singular */
    double aa, ab, bb, scale;
} zd_inverse_of_two;

/* Inverse of a block given by its lower triangle, with one division instead of two that depend on each other. Each relative pivot is at
 * least the product of both; only if that product is below the smallest relative pivot so far, the pivots are compared individually, and
 * checked if one is smaller. `row` is the first row of the block. */
ZD_INLINE zd_inverse_of_two zd_invert_two(const double *diagonal, int row, const double *P, zd_pivots *pivots)
{
    const double a = P[0], b = P[2], c = P[3], determinant = a * c - b * b, rounding = 2 * 0x1p-52;
    int are_pivots = 1;
    const double second = determinant * pivots->diagonal, least = pivots->pivot * diagonal[1];
    const int is_product_less = !(second >= diagonal[0] * least);
    const int is_less = is_product_less && (!(a * pivots->diagonal >= pivots->pivot * diagonal[0]) || !(second >= a * least));
    if (!(a > 0) || is_less || !(determinant < INFINITY))
        are_pivots = zd_judge_pivot(pivots, row, a, diagonal[0], rounding)
                   & zd_judge_pivot(pivots, row + 1, determinant, a * diagonal[1], rounding);
    return (zd_inverse_of_two){c, -b, a, are_pivots ? 1 / determinant : 0};
}

#endif
