#include "gram.h"

#include <string.h>

#include "../linalg/small.h"

/* The entries of one block in the rows of one group. */
typedef struct part {
    const double *x;        /* of its first row */
    int width;              /* from row to row */
    int first, end;         /* its rows */
} part;

static part part_of(const zd_layout *layout, const double *Y, int toucher)
{
    int g = layout->toucher[toucher];
    return (part){Y + layout->C_at[g] + layout->toucher_offset[toucher], layout->width[g], layout->row_at[g], layout->row_at[g + 1]};
}

/* g (count,) += the products of y, weighed, with so many rows */
ZD_INLINE void add_products(const int n, const double *W, const double *y, const double *other, int width, int count, double *g)
{
    for (int l = 0; l < count; l++, other += width) {
        double sum = 0;
        for (int i = 0; i < n; i++) sum += (W ? W[i] * y[i] : y[i]) * other[i];
        g[l] += sum;
    }
}

static void add_block(int n, int m, const double *W, part one, part other, double *G)
{
    for (int k = one.first; k < one.end; k++, one.x += one.width)
        ZD_SIZED(add_products, n, W, one.x, other.x, other.width, other.end - other.first, G + k * m + other.first);
}

void zd_gram(const zd_layout *layout, const double *Y, const double *W, double *G)
{
    const int m = layout->row_at[layout->groups];
    memset(G, 0, (size_t)(m * m) * sizeof *G);
    for (int b = 0; b < layout->blocks; b++) {
        int first = layout->velocity_at[b], n = layout->velocity_at[b + 1] - first;
        for (int i = layout->toucher_at[b]; i < layout->toucher_at[b + 1]; i++)
            for (int j = layout->toucher_at[b]; j <= i; j++)
                add_block(n, m, W ? W + first : NULL, part_of(layout, Y, i), part_of(layout, Y, j), G);
    }
}
