/* Blocks of S(W): S_gh = sum_b C_gb W_b C_hb^T, over the bodies b that both groups of constraints g and h touch.
 *
 * All groups on a body are coupled with each other, so that the cost would grow with the square of a body's number of joints. A body with
 * many joints is therefore split into parts of equal mass, each with some of the joints and welded to the next: the motion is the same,
 * the welds transmit the forces, and no block row of S has many blocks. A weld has the rows [I, -I] on its two parts; as these move alike,
 * its right-hand side is zero.
 */
#include "weighted.h"

#include <string.h>

enum { TOUCHERS_OF_COPY = 4 };

static int touchers_of(const zd_layout *layout, int b) { return layout->toucher_at[b + 1] - layout->toucher_at[b]; }
static int copies_of(const zd_layout *layout, int b)
{
    const int touchers = touchers_of(layout, b);
    return touchers <= layout->max_touchers ? 1 : (touchers + TOUCHERS_OF_COPY - 1) / TOUCHERS_OF_COPY;
}
static int velocities_of(const zd_layout *layout, int b) { return layout->velocity_at[b + 1] - layout->velocity_at[b]; }

/* Sizes of the pattern; a clique is a body or a part of one. */
typedef struct counts {
    int rows, cliques, members, max_members, pairs, largest, largest_block;
} counts;

/* Constraints on part i of a body: joints from `first` on, and up to two welds. */
typedef struct part {
    int first, joints, has_weld_before, has_weld_behind;
} part;

static part part_of(const zd_layout *layout, int b, int i)
{
    const int copies = copies_of(layout, b), begin = layout->toucher_at[b], touchers = touchers_of(layout, b);
    if (copies == 1) return (part){begin, touchers, 0, 0};
    const int before = i * TOUCHERS_OF_COPY, left = touchers - before;
    return (part){begin + before, left < TOUCHERS_OF_COPY ? left : TOUCHERS_OF_COPY, i > 0, i + 1 < copies};
}

static int members_of(part it) { return it.joints + it.has_weld_before + it.has_weld_behind; }

static counts count_all(const zd_layout *layout)
{
    counts all = {.rows = layout->groups};
    for (int g = 0; g < layout->groups; g++) {
        const int rows = layout->row_at[g + 1] - layout->row_at[g];
        all.largest_block = rows > all.largest_block ? rows : all.largest_block;
    }
    for (int b = 0; b < layout->blocks; b++) {
        const int copies = copies_of(layout, b), n = velocities_of(layout, b);
        all.rows += copies - 1;
        all.cliques += copies;
        all.largest = n > all.largest ? n : all.largest;
        for (int i = 0; i < copies; i++) {
            const int members = members_of(part_of(layout, b, i));
            all.members += members;
            all.max_members = members > all.max_members ? members : all.max_members;
            all.pairs += members * (members + 1) / 2;
        }
    }
    if (all.largest > all.largest_block) all.largest_block = all.largest;
    return all;
}

/* The pattern of S, on memory of its own: block rows are the groups, then the welds. */
static zd_pattern lay_out_pattern(zd_arena *arena, const zd_layout *layout, const counts *all)
{
    int *size = zd_arena_ints(arena, all->rows), *begin = zd_arena_ints(arena, all->cliques + 1);
    int *member = zd_arena_ints(arena, all->members);
    zd_pattern pattern = {all->rows, size, all->cliques, begin, member};
    if (!arena->base) return pattern;
    for (int g = 0; g < layout->groups; g++) size[g] = layout->row_at[g + 1] - layout->row_at[g];
    for (int b = 0, clique = 0, next = 0, weld = layout->groups; b < layout->blocks; b++)
        for (int i = 0; i < copies_of(layout, b); i++) {
            const part it = part_of(layout, b, i);
            for (int j = 0; j < it.joints; j++) member[next++] = layout->toucher[it.first + j];
            if (it.has_weld_before) member[next++] = weld++;
            if (it.has_weld_behind) member[next++] = weld, size[weld] = velocities_of(layout, b);
            begin[++clique] = next;
        }
    return pattern;
}

static zd_piece piece_of(const zd_weighted *self, int b, int toucher)
{
    const zd_layout *layout = self->layout;
    const int g = layout->toucher[toucher];
    return (zd_piece){
        .C = layout->C_at[g] + layout->toucher_offset[toucher],
        .stride = layout->width[g],
        .rows = layout->row_at[g + 1] - layout->row_at[g],
        .n = velocities_of(layout, b),
        .row = layout->row_at[g],
        .W = layout->M_at[b],
        .is_diagonal = layout->is_diagonal[b],
        .copies = copies_of(layout, b),
    };
}

static zd_piece weld_of(const zd_weighted *self, int b, int is_behind)
{
    const zd_layout *layout = self->layout;
    const int n = velocities_of(layout, b), whole = self->largest * self->largest;
    return (zd_piece){.C = is_behind ? 0 : whole, .stride = self->largest, .rows = n, .n = n, .W = layout->M_at[b],
                      .is_diagonal = layout->is_diagonal[b], .copies = copies_of(layout, b), .is_weld = 1};
}

/* Kernel of two pieces: for bodies in the plane and in space, and groups with equal numbers of rows; 0: none. */
static int kernel_of(const zd_piece *a, const zd_piece *b)
{
    const int is_plain = a->is_diagonal && a->copies == 1 && a->rows == b->rows;
    const int is_known = a->n == 3 ? a->rows <= 3 : a->n == 6 && (a->rows == 3 || a->rows == 5 || a->rows == 6 || a->rows == 1);
    return is_plain && is_known ? 10 * a->n + a->rows + (a == b ? ZD_SQUARE : 0) : 0;
}

static zd_pair pair_of(const zd_weighted *self, int a, int b, int to)
{
    const zd_piece *one = self->piece + a, *other = self->piece + b;
    const int kernel = kernel_of(one, other);
    return (zd_pair){kernel, kernel ? one->C : a, kernel ? other->C : b, one->stride, other->stride, one->W, to};
}

/* The pairs of the pieces from `first` on, of the block rows that `member` has. */
static void list_pairs(zd_weighted *self, const int *piece, const int *member, int members)
{
    const int *place = self->blocks->place;
    for (int i = 0; i < members; i++)
        for (int j = 0; j <= i; j++) {
            const int is_later = place[member[i]] >= place[member[j]], a = piece[is_later ? i : j], b = piece[is_later ? j : i];
            const int to = zd_blocks_find(self->blocks, member[i], member[j]);
            self->at[self->pairs++] = 2 * to + !is_later;
            self->pair[i == j ? self->squares++ : self->members + self->others++] = pair_of(self, a, b, to);
        }
}

/* Fills pieces and pairs: pieces of joints first, then those of welds. `piece`: temporary indices of the pieces of one clique. */
static void fill(zd_weighted *self, const zd_pattern *pattern, int *piece)
{
    const zd_layout *layout = self->layout;
    const int joints = layout->toucher_at[layout->blocks];
    int weld = joints, clique = 0;
    for (int b = 0; b < layout->blocks; b++)
        for (int i = 0; i < copies_of(layout, b); i++, clique++) {
            const part it = part_of(layout, b, i);
            int members = 0;
            for (int j = 0; j < it.joints; j++) {
                self->piece[self->pieces] = piece_of(self, b, it.first + j);
                piece[members++] = self->pieces++;
            }
            if (it.has_weld_before) self->piece[weld] = weld_of(self, b, 0), piece[members++] = weld++;
            if (it.has_weld_behind) self->piece[weld] = weld_of(self, b, 1), piece[members++] = weld++;
            list_pairs(self, piece, pattern->member + pattern->begin[clique], members);
        }
    for (int i = 0; i < self->largest; i++) {
        self->weld[i * (self->largest + 1)] = 1;
        self->weld[i * (self->largest + 1) + self->largest * self->largest] = -1;
    }
}

typedef struct plan {       /* sizes and pattern that determine the memory */
    const zd_layout *layout;
    counts all;
    zd_pattern pattern;
    zd_ordering ordering;
} plan;

static void *create(zd_arena *arena, const void *of)
{
    const plan *it = of;
    const int joints = it->layout->toucher_at[it->layout->blocks], welds = it->all.rows - it->layout->groups, largest = it->all.largest;
    int *piece = zd_arena_ints(arena, it->all.max_members);
    zd_weighted self = {
        .layout = it->layout,
        .blocks = zd_blocks_create(arena, &it->ordering),
        .piece = zd_arena_bytes(arena, (joints + 2 * welds) * sizeof(zd_piece)),
        .pair = zd_arena_bytes(arena, it->all.pairs * sizeof(zd_pair)),
        .at = zd_arena_ints(arena, it->all.pairs),
        .weld = zd_arena_doubles(arena, welds ? 2 * (size_t)(largest * largest) : 0),
        .members = it->all.members,
        .largest = largest,
        .row = zd_arena_ints(arena, it->layout->groups),
        .product = zd_arena_doubles(arena, it->all.largest_block * largest),
    };
    if (!welds) self.largest = 0;
    if (arena->base) {
        for (int g = 0; g < it->layout->groups; g++) self.row[g] = self.blocks->at[self.blocks->place[g]];
        fill(&self, &it->pattern, piece);
    }
    self.row_groups = zd_row_groups_create(arena, it->layout, self.row);
    return zd_arena_copy(arena, &self, sizeof self);
}

zd_weighted *zd_weighted_create(zd_store *store, const zd_layout *layout)
{
    plan it = {.layout = layout, .all = count_all(layout)};
    zd_arena counting = {0};
    lay_out_pattern(&counting, layout, &it.all);
    zd_arena arena = {.base = zd_allocate(counting.used)};
    if (!arena.base) return NULL;
    it.pattern = lay_out_pattern(&arena, layout, &it.all);
    zd_weighted *self = NULL;
    if (zd_ordering_find(&it.pattern, NULL, &it.ordering)) {
        self = zd_store_create(store, create, &it);
        zd_ordering_free(&it.ordering);
    }
    zd_release(arena.base);
    return self;
}
