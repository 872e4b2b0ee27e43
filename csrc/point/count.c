/* What a structure costs: the multiplications in S(W) = C W C^T of (13) and (27), in its factors, and in a solve with them. They are counted
 * from the order that a run eliminates in, with fill, so that mechanisms can take the coordinates that cost less. Where blocks have no kernel
 * of their size, as those of bodies with many joints do not, they take some three times as long, and count as so many.
 */
#include "../zerodrift.h"
#include "weighted.h"

static const double WITHOUT_KERNEL = 3;     /* measured: tests/bench/bench_coordinates.py */

/* A W B^T: the blocks of two groups and a body. */
static double count_pairs(const zd_weighted *self)
{
    double count = 0;
    for (int i = 0; i < self->pairs; i++) {
        const zd_pair *pair = self->pair + i;
        const int kernel = pair->kernel % ZD_SQUARE, n = kernel ? kernel / 10 : self->piece[pair->a].n;
        const int rows = kernel ? kernel % 10 : self->piece[pair->a].rows, others = kernel ? rows : self->piece[pair->b].rows;
        count += (kernel ? 1 : WITHOUT_KERNEL) * rows * n * others;
    }
    return count;
}

/* Of a column with s rows in its pivot and b below that: L, what it takes from what follows, and its part of a solve. */
static double count_column(double s, double b) { return s * s * s / 6 + s * s * b + s * b * b / 2 + s * s + 2 * s * b; }

static double count_factors(const zd_blocks *blocks)
{
    double count = 0;
    for (int k = 0; k < blocks->count; k++) {
        int below = 0;
        for (int i = blocks->begin[k]; i < blocks->begin[k + 1]; i++) below += blocks->at[blocks->row[i] + 1] - blocks->at[blocks->row[i]];
        count += (blocks->kernel[k] ? 1 : WITHOUT_KERNEL) * count_column(blocks->at[k + 1] - blocks->at[k], below);
    }
    return count;
}

double zd_structure_count(const zd_system *system)
{
    if (!system->structure) return 0;
    zd_arena counting = {NULL, 0};
    zd_layout_take(&counting, system);
    zd_arena arena = {zd_allocate(counting.used), 0};
    if (!arena.base) return -1;
    zd_store store = {NULL};
    const zd_weighted *weighted = zd_weighted_create(&store, zd_layout_take(&arena, system));
    const double count = weighted ? count_pairs(weighted) + count_factors(weighted->blocks) : -1;
    zd_store_release(&store);
    zd_release(arena.base);
    return count;
}
