/* Symbolic factorization: offsets of all blocks in the factors of a block matrix, computed once. */
#include "blocks.h"

#include <string.h>

#include "../small.h"
#include "../small.h"

/* ---- memory ---- */

typedef struct counts {
    int rows, largest;      /* scalar rows; those of the largest block row */
    int numbers;            /* size of S */
    int targets;            /* number of products added to off-diagonal blocks in the elimination */
} counts;

static counts count_all(const zd_ordering *ordering)
{
    const int *size = ordering->size;
    counts all = {0, 0, 0, 0};
    for (int k = 0; k < ordering->count; k++) {
        const int below = ordering->begin[k + 1] - ordering->begin[k];
        all.rows += size[k];
        all.largest = size[k] > all.largest ? size[k] : all.largest;
        all.numbers += size[k] * size[k];
        all.targets += below * (below - 1) / 2;
        for (int e = ordering->begin[k]; e < ordering->begin[k + 1]; e++) all.numbers += size[ordering->row[e]] * size[k];
    }
    return all;
}

static int find_entry(const zd_blocks *self, int column, int row)
{
    int low = self->begin[column], high = self->begin[column + 1] - 1;
    while (low < high) {
        const int middle = low + (high - low) / 2;
        if (self->row[middle] < row) low = middle + 1;
        else high = middle;
    }
    return self->entry_at[low];
}

int zd_blocks_find(const zd_blocks *self, int i, int j)
{
    const int a = self->place[i], b = self->place[j];
    return a == b ? self->pivot_at[a] : a > b ? find_entry(self, b, a) : find_entry(self, a, b);
}

static void fill_offsets(zd_blocks *self, const int *size)
{
    int next = 0;
    for (int k = 0; k < self->count; k++) {
        self->at[k + 1] = self->at[k] + size[k];
        self->pivot_at[k] = next;
        next += size[k] * size[k];
    }
    self->pivot_at[self->count] = next;
    for (int k = 0; k < self->count; k++) {
        self->kernel[k] = size[k] <= ZD_UNROLLED && size[k] != 4 ? size[k] : 0;
        for (int e = self->begin[k]; e < self->begin[k + 1]; e++) {
            self->entry_at[e] = next;
            next += size[self->row[e]] * size[k];
            if (size[self->row[e]] != size[k]) self->kernel[k] = 0;
        }
    }
    self->entry_at[self->begin[self->count]] = next;
    self->uniform = self->count ? self->kernel[0] : 0;
    for (int k = 0; k < self->count; k++)
        if (self->kernel[k] != self->uniform) self->uniform = 0;
}

static void fill_targets(zd_blocks *self)
{
    int next = 0;
    for (int k = 0; k < self->count; k++) {
        self->target_begin[k] = next;
        for (int e = self->begin[k]; e < self->begin[k + 1]; e++)
            for (int f = self->begin[k]; f < e; f++) self->target[next++] = find_entry(self, self->row[f], self->row[e]);
    }
    self->target_begin[self->count] = next;
}

zd_blocks *zd_blocks_create(zd_arena *arena, const zd_ordering *ordering)
{
    const int count = ordering->count, entries = ordering->begin[count];
    const counts all = count_all(ordering);
    zd_blocks self = {
        .count = count,
        .rows = all.rows,
        .place = zd_arena_ints(arena, count),
        .at = zd_arena_ints(arena, count + 1),
        .pivot_at = zd_arena_ints(arena, count + 1),
        .begin = zd_arena_ints(arena, count + 1),
        .row = zd_arena_ints(arena, entries),
        .entry_at = zd_arena_ints(arena, entries + 1),
        .target_begin = zd_arena_ints(arena, count + 1),
        .target = zd_arena_ints(arena, all.targets),
        .kernel = zd_arena_ints(arena, count),
        .size = all.numbers,
        .S = zd_arena_doubles(arena, all.numbers),
        .diagonal = zd_arena_doubles(arena, all.rows),
        .product = zd_arena_doubles(arena, all.largest * all.largest),
        .x = zd_arena_doubles(arena, all.rows),
    };
    if (arena->base) {
        memcpy(self.place, ordering->place, count * sizeof(int));
        memcpy(self.begin, ordering->begin, (count + 1) * sizeof(int));
        memcpy(self.row, ordering->row, entries * sizeof(int));
        fill_offsets(&self, ordering->size);
        fill_targets(&self);
    }
    return zd_arena_copy(arena, &self, sizeof self);
}

void zd_blocks_clear(zd_blocks *self)
{
    zd_clear(self->size, self->S);
}
