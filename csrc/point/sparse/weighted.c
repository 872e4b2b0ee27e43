/* Blocks of S(W): S_gh = sum_b C_gb W_b C_hb^T, over the bodies b that both groups of constraints g and h touch.
 *
 * All groups on a body are coupled with each other, so that the cost would grow with the square of a body's number of joints. A body with
 * many joints is therefore split into parts of equal mass, each with some of the joints and welded to the next: the motion is the same,
 * the welds transmit the forces, and no block row of S has many blocks. A weld has the rows [I, -I] on its two parts; as these move alike,
 * its right-hand side is zero.
 */
#include "weighted.h"

#include <math.h>
#include <string.h>

#include "../../linalg/refinement.h"
#include "../../linalg/small.h"

enum { TOUCHERS_OF_COPY = 4 };

/* ---- symbolic ---- */

static int *take_ints(zd_arena *arena, int count) { return zd_take(arena, (size_t)count * sizeof(int)); }

static int touchers_of(const zd_layout *layout, int b) { return layout->toucher_at[b + 1] - layout->toucher_at[b]; }
static int copies_of(const zd_layout *layout, int b)
{
    const int touchers = touchers_of(layout, b);
    return touchers <= layout->most_touchers ? 1 : (touchers + TOUCHERS_OF_COPY - 1) / TOUCHERS_OF_COPY;
}
static int velocities_of(const zd_layout *layout, int b) { return layout->velocity_at[b + 1] - layout->velocity_at[b]; }

/* Sizes of the pattern; a clique is a body or a part of one. */
typedef struct counts {
    int rows, cliques, members, most_members, pairs, largest, largest_block;
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
            all.most_members = members > all.most_members ? members : all.most_members;
            all.pairs += members * (members + 1) / 2;
        }
    }
    if (all.largest > all.largest_block) all.largest_block = all.largest;
    return all;
}

/* The pattern of S, on memory of its own: block rows are the groups, then the welds. */
static zd_pattern lay_out_pattern(zd_arena *arena, const zd_layout *layout, const counts *all)
{
    int *size = take_ints(arena, all->rows), *begin = take_ints(arena, all->cliques + 1), *member = take_ints(arena, all->members);
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

static void *take(zd_arena *arena, const void *of)
{
    const plan *it = of;
    const int joints = it->layout->toucher_at[it->layout->blocks], welds = it->all.rows - it->layout->groups, largest = it->all.largest;
    int *piece = take_ints(arena, it->all.most_members);
    zd_weighted self = {
        .layout = it->layout,
        .blocks = zd_blocks_take(arena, &it->ordering),
        .piece = zd_take(arena, (size_t)(joints + 2 * welds) * sizeof(zd_piece)),
        .pair = zd_take(arena, (size_t)it->all.pairs * sizeof(zd_pair)),
        .at = take_ints(arena, it->all.pairs),
        .weld = zd_take_doubles(arena, welds ? 2 * (size_t)(largest * largest) : 0),
        .members = it->all.members,
        .largest = largest,
        .row = take_ints(arena, it->layout->groups),
        .product = zd_take_doubles(arena, (size_t)(it->all.largest_block * largest)),
    };
    if (!welds) self.largest = 0;
    if (arena->base) {
        for (int g = 0; g < it->layout->groups; g++) self.row[g] = self.blocks->at[self.blocks->place[g]];
        fill(&self, &it->pattern, piece);
    }
    self.row_groups = zd_row_groups_take(arena, it->layout, self.row);
    return zd_take_filled(arena, &self, sizeof self);
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
        self = zd_store_take(store, take, &it);
        zd_ordering_free(&it.ordering);
    }
    zd_release(arena.base);
    return self;
}

/* ---- S ---- */

/* product (rows, n) <- A W of a body */
ZD_INLINE void weigh(const int rows, const int n, const double *A, int stride, const double *W, double *product)
{
    for (int i = 0; i < rows; i++)
        for (int j = 0; j < n; j++) product[i * n + j] = A[i * stride + j] * W[j];
}

static void weigh_any(const zd_piece *a, const double *A, const double *W, double *product)
{
    const int n = a->n;
    if (a->is_diagonal) weigh(a->rows, n, A, a->stride, W, product);
    for (int i = 0; !a->is_diagonal && i < a->rows; i++) {
        zd_forward(n, W, A + i * a->stride, product + i * n);
        zd_backward(n, W, product + i * n, product + i * n);
    }
    for (int i = 0; a->copies > 1 && i < a->rows * n; i++) product[i] *= a->copies;
}

/* to (rows, columns) <- to + A B^T, A (rows, n) */
ZD_INLINE void add_product(const int rows, const int columns, const int n, const double *A, const double *B, int stride, double *to)
{
    for (int i = 0; i < rows; i++)
        for (int j = 0; j < columns; j++) to[i * columns + j] += zd_dot(n, A + i * n, B + j * stride);
}

/* to (columns,) <- to + a W B^T, of a row a (n,) */
ZD_INLINE void add_row(const int columns, const int n, const double *restrict a, const double *restrict W, const double *restrict B,
                       int stride, double *restrict to)
{
    double weighted[ZD_UNROLLED];
    for (int i = 0; i < n; i++) weighted[i] = a[i] * W[i];
    for (int j = 0; j < columns; j++) to[j] += zd_dot(n, weighted, B + j * stride);
}

/* to <- to + A W B^T; for a piece with itself the lower triangle only, as no more is read of a diagonal block. */
ZD_INLINE void add_weighted(const int is_square, const int rows, const int n, const double *A, int stride, const double *W, const double *B,
                            int stride_of_B, double *to)
{
    for (int i = 0; i < rows; i++) add_row(is_square ? i + 1 : rows, n, A + i * stride, W, B, stride_of_B, to + i * rows);
}

static const double *entries(const zd_weighted *self, const zd_piece *piece, const double *C)
{
    return (piece->is_weld ? self->weld : C) + piece->C;
}

static void add_any(zd_weighted *self, const zd_piece *a, const zd_piece *b, const double *C, const double *W, double *to)
{
    weigh_any(a, entries(self, a, C), W + a->W, self->product);
    add_product(a->rows, b->rows, a->n, self->product, entries(self, b, C), b->stride, to);
}

/* Pairs of one kernel, mostly many in succession; returns the first of another. */
ZD_INLINE const zd_pair *add_pairs(const int square, const int n, const int rows, const zd_weighted *self, const zd_pair *pair,
                                   const double *C, const double *W)
{
    const zd_pair *end = self->pair + self->pairs;
    double *S = self->blocks->S;
    do {
        const double *A = C + pair->a, *B = square ? A : C + pair->b;
        add_weighted(square, rows, n, A, pair->stride_of_a, W + pair->W, B, square ? pair->stride_of_a : pair->stride_of_b, S + pair->to);
    } while (++pair < end && pair->kernel == square + 10 * n + rows);
    return pair;
}

static void fill_S(zd_weighted *self, const double *C, const double *W)
{
    zd_blocks_clear(self->blocks);
#define KERNEL(n, rows)                                                                             \
    case 10 * n + rows: pair = add_pairs(0, n, rows, self, pair, C, W); break;                      \
    case ZD_SQUARE + 10 * n + rows: pair = add_pairs(ZD_SQUARE, n, rows, self, pair, C, W); break;
    for (const zd_pair *pair = self->pair; pair < self->pair + self->pairs;) switch (pair->kernel) {
        KERNEL(3, 1)
        KERNEL(3, 2)
        KERNEL(3, 3)
        KERNEL(6, 1)
        KERNEL(6, 3)
        KERNEL(6, 5)
        KERNEL(6, 6)
        default:
            add_any(self, self->piece + pair->a, self->piece + pair->b, C, W, self->blocks->S + pair->to);
            pair++;
        }
#undef KERNEL
}

zd_pivots zd_weighted_factor(zd_weighted *self, const double *C, const double *W, double *y)
{
    fill_S(self, C, W);
    return zd_blocks_factor(self->blocks, NULL, 0, y);
}

/* The system's own products do not know split bodies. */
const zd_operations *zd_weighted_products(const zd_weighted *self, const zd_system *system)
{
    const zd_operations *products = system->operations;
    return products && products->add_weighted && !zd_weighted_has_welds(self) ? products : NULL;
}

zd_pivots zd_weighted_factor_by(zd_weighted *self, const zd_operations *products, const void *data, const zd_terms *terms, const double *W,
                               double *y)
{
    zd_blocks_clear(self->blocks);
    products->add_weighted(data, terms, W, self->at, self->blocks->S);
    return zd_blocks_factor(self->blocks, NULL, 0, y);
}

zd_pivots zd_weighted_factor_without(zd_weighted *self, const double *C, const double *W, unsigned char *without)
{
    fill_S(self, C, W);
    return zd_blocks_factor(self->blocks, without, -1, NULL);
}

int zd_weighted_leave_out(zd_weighted *self, const double *C, const double *W, double least, unsigned char *left_out)
{
    const zd_layout *layout = self->layout;
    unsigned char *in_order = zd_allocate((size_t)self->blocks->rows);
    int of_welds = 0;
    if (!in_order) return -1;
    fill_S(self, C, W);
    (void)zd_blocks_factor(self->blocks, in_order, least, NULL);
    for (int i = 0; i < self->blocks->rows; i++) of_welds += in_order[i];
    for (int g = 0; g < layout->groups; g++)
        for (int k = layout->row_at[g], i = self->row[g]; k < layout->row_at[g + 1]; k++, i++) of_welds -= left_out[k] = in_order[i];
    zd_release(in_order);
    return of_welds;
}

void zd_weighted_times(const zd_weighted *self, const double *C, const double *x, const double *rhs, double *y)
{
    if (zd_weighted_has_welds(self)) memset(y, 0, (size_t)self->blocks->rows * sizeof *y);
    zd_row_groups_times(&self->row_groups, C, x, rhs, y);
}

int zd_weighted_row(const zd_weighted *self, int place)
{
    const zd_layout *layout = self->layout;
    for (int g = 0; g < layout->groups; g++)
        if (place >= self->row[g] && place < self->row[g] + layout->row_at[g + 1] - layout->row_at[g])
            return layout->row_at[g] + place - self->row[g];
    return 0;
}

/* Contribution c W c^T of a body to a diagonal entry of S; W is diagonal. */
static double contribution(const zd_piece *piece, int row, const double *C, const double *W)
{
    const double *c = C + piece->C + row * piece->stride, *w = W + piece->W;
    double sum = 0;
    for (int i = 0; i < piece->n; i++) sum += c[i] * w[i] * c[i];
    return sum;
}

int zd_weighted_is_alike(const zd_weighted *self, const double *C, const double *W, double *least, double *most)
{
    const int m = self->layout->row_at[self->layout->groups];
    if (zd_weighted_has_welds(self)) return 0;
    for (int k = 0; k < m; k++) least[k] = INFINITY, most[k] = 0;
    for (const zd_piece *piece = self->piece; piece < self->piece + self->pieces; piece++)
        for (int i = 0; i < piece->rows; i++) {
            if (!piece->is_diagonal) return 0;
            const int k = piece->row + i;
            const double share = contribution(piece, i, C, W);
            if (!(share > 0)) continue;
            least[k] = fmin(least[k], share);
            most[k] = fmax(most[k], share);
        }
    for (int k = 0; k < m; k++)
        if (most[k] > ZD_UNEQUAL_SHARES * least[k]) return 0;
    return 1;
}
