/* Block L D L^T, right-looking: once the block row k is eliminated, with P = D_k^-1 and B_i the blocks below it,
 *
 *     L_i = B_i P,        S_ij <- S_ij - B_i L_j^T,        S_ii <- S_ii - L_i B_i^T
 *
 * where each S_ij stands was found beforehand, so that nothing is searched. Diagonal blocks are inverted by scalar pivots: a row that is
 * left out has none. Solutions take two products with each block.
 */
#include "blocks.h"

#include <math.h>
#include <string.h>

#include "small.h"

/* ---- memory ---- */

static int *take_ints(zd_arena *arena, int count) { return zd_take(arena, (size_t)count * sizeof(int)); }

typedef struct counts {
    int rows, largest;      /* of a block row */
    int numbers;            /* of S */
    int targets;            /* products of elimination that go to blocks beside the diagonal */
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

static int size_at(const zd_blocks *self, int k) { return self->at[k + 1] - self->at[k]; }

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
        self->kernel[k] = size[k] <= ZD_UNROLLED ? size[k] : 0;
        for (int e = self->begin[k]; e < self->begin[k + 1]; e++) {
            self->entry_at[e] = next;
            next += size[self->row[e]] * size[k];
            if (size[self->row[e]] != size[k]) self->kernel[k] = 0;
        }
    }
    self->entry_at[self->begin[self->count]] = next;
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

zd_blocks *zd_blocks_take(zd_arena *arena, const zd_ordering *ordering)
{
    const int count = ordering->count, entries = ordering->begin[count];
    const counts all = count_all(ordering);
    zd_blocks self = {
        .count = count,
        .rows = all.rows,
        .place = take_ints(arena, count),
        .at = take_ints(arena, count + 1),
        .pivot_at = take_ints(arena, count + 1),
        .begin = take_ints(arena, count + 1),
        .row = take_ints(arena, entries),
        .entry_at = take_ints(arena, entries + 1),
        .target_begin = take_ints(arena, count + 1),
        .target = take_ints(arena, all.targets),
        .kernel = take_ints(arena, count),
        .size = all.numbers,
        .S = zd_take_doubles(arena, (size_t)all.numbers),
        .diagonal = zd_take_doubles(arena, (size_t)all.rows),
        .product = zd_take_doubles(arena, (size_t)(all.largest * all.largest)),
        .x = zd_take_doubles(arena, (size_t)all.rows),
    };
    if (arena->base) {
        memcpy(self.place, ordering->place, (size_t)count * sizeof(int));
        memcpy(self.begin, ordering->begin, (size_t)(count + 1) * sizeof(int));
        memcpy(self.row, ordering->row, (size_t)entries * sizeof(int));
        fill_offsets(&self, ordering->size);
        fill_targets(&self);
    }
    return zd_take_filled(arena, &self, sizeof self);
}

void zd_blocks_clear(zd_blocks *self)
{
    memset(self->S, 0, (size_t)self->size * sizeof *self->S);
}

/* ---- factors ---- */

/* Whether this pivot is positive; keeps the smallest share. Compared by products, as divisions would be waited for. */
ZD_INLINE int judge(zd_pivots *pivots, int row, double pivot, double diagonal, double rounding)
{
    if (!(pivot > rounding * diagonal) || !(pivot < INFINITY)) {
        if (pivots->failed < 0) pivots->failed = row;
        return 0;
    }
    if (pivot * pivots->diagonal < pivots->pivot * diagonal) pivots->smallest = row, pivots->pivot = pivot, pivots->diagonal = diagonal;
    return 1;
}

/* P (n, n) <- L^-T D^-1 L^-1, where its lower triangle is L D L^T; what is left out has no part in it. `row` is that of its first one. */
ZD_INLINE void invert(const int n, zd_blocks *self, int row, double *P, unsigned char *left_out, double least, zd_pivots *pivots)
{
    const double rounding = n * 0x1p-52;
    for (int i = 0; i < n; i++) {           /* D in reciprocals on the diagonal, L below it */
        double pivot = P[i * n + i];
        for (int j = 0; j < i; j++) {
            const double scaled = P[i * n + j];
            P[i * n + j] *= P[j * n + j];
            pivot -= P[i * n + j] * scaled;
        }
        if (left_out && least >= 0) left_out[row + i] = !(pivot > least * self->diagonal[row + i]);
        const int is_pivot = !(left_out && left_out[row + i]) && judge(pivots, row + i, pivot, self->diagonal[row + i], rounding);
        P[i * n + i] = is_pivot ? 1 / pivot : 0;
        for (int k = i + 1; k < n; k++) {
            double sum = P[k * n + i];
            for (int j = 0; j < i; j++) sum -= P[k * n + j] * P[i * n + j];
            P[k * n + i] = is_pivot ? sum : 0;      /* of L D, for now */
        }
    }
    zd_invert(n, P);
}

/* The same of two rows, by one division: both pivots would take one each, and the second would wait for the first. */
ZD_INLINE void invert_two(zd_blocks *self, int row, double *P, zd_pivots *pivots)
{
    const double a = P[0], b = P[2], c = P[3], determinant = a * c - b * b, *diagonal = self->diagonal + row;
    const double rounding = 2 * 0x1p-52;
    const int are_pivots = judge(pivots, row, a, diagonal[0], rounding) & judge(pivots, row + 1, determinant, a * diagonal[1], rounding);
    const double scale = are_pivots ? 1 / determinant : 0;
    P[0] = c * scale;
    P[1] = P[2] = -b * scale;
    P[3] = a * scale;
}

/* to (a, b) <- to - A B^T, A (a, n), B (b, n) */
ZD_INLINE void subtract_product(const int a, const int b, const int n, const double *A, const double *B, double *to)
{
    for (int i = 0; i < a; i++)
        for (int j = 0; j < b; j++) {
            double sum = to[i * b + j];
            for (int k = 0; k < n; k++) sum -= A[i * n + k] * B[j * n + k];
            to[i * b + j] = sum;
        }
}

/* to (a, n) <- B P, P (n, n) symmetric */
ZD_INLINE void multiply(const int a, const int n, const double *B, const double *P, double *to)
{
    for (int i = 0; i < a; i++)
        for (int j = 0; j < n; j++) {
            double sum = B[i * n] * P[j * n];
            for (int k = 1; k < n; k++) sum += B[i * n + k] * P[j * n + k];
            to[i * n + j] = sum;
        }
}

/* Column k; `uniform`: the size of all its blocks, n */
ZD_INLINE void eliminate(const int n, const int uniform, zd_blocks *self, int k, unsigned char *left_out, double least, zd_pivots *pivots)
{
    double *S = self->S, *P = S + self->pivot_at[k], here[ZD_UNROLLED * ZD_UNROLLED], *product = uniform ? here : self->product;
    const int *target = self->target + self->target_begin[k], first = self->begin[k];
    if (uniform && n == 2 && !left_out) invert_two(self, self->at[k], P, pivots);
    else invert(n, self, self->at[k], P, left_out, least, pivots);
    for (int e = first; e < self->begin[k + 1]; e++) {
        const int row = self->row[e], a = uniform ? n : size_at(self, row);
        double *B = S + self->entry_at[e];
        for (int f = first; f < e; f++) {
            const int b = uniform ? n : size_at(self, self->row[f]);
            subtract_product(a, b, n, B, S + self->entry_at[f], S + *target++);
        }
        multiply(a, n, B, P, product);
        subtract_product(a, a, n, product, B, S + self->pivot_at[row]);
        memcpy(B, product, (size_t)(a * n) * sizeof *B);
    }
}

zd_pivots zd_blocks_factor(zd_blocks *self, unsigned char *left_out, double least)
{
    zd_pivots pivots = {-1, 0, 1, 1};
    for (int k = 0; k < self->count; k++) {
        const int n = size_at(self, k);
        const double *P = self->S + self->pivot_at[k];
        for (int i = 0; i < n; i++) self->diagonal[self->at[k] + i] = P[i * (n + 1)];
    }
    for (int k = 0; k < self->count; k++) switch (self->kernel[k]) {
        case 1: eliminate(1, 1, self, k, left_out, least, &pivots); break;
        case 2: eliminate(2, 1, self, k, left_out, least, &pivots); break;
        case 3: eliminate(3, 1, self, k, left_out, least, &pivots); break;
        case 5: eliminate(5, 1, self, k, left_out, least, &pivots); break;
        case 6: eliminate(6, 1, self, k, left_out, least, &pivots); break;
        default: eliminate(size_at(self, k), 0, self, k, left_out, least, &pivots);
        }
    return pivots;
}

/* ---- solution ---- */

/* y (a,) <- y - L x, L (a, n) */
ZD_INLINE void subtract_times(const int a, const int n, const double *L, const double *x, double *y)
{
    for (int i = 0; i < a; i++) {
        double sum = y[i];
        for (int k = 0; k < n; k++) sum -= L[i * n + k] * x[k];
        y[i] = sum;
    }
}

ZD_INLINE void forward(const int n, const int uniform, const zd_blocks *self, int k, double *x)
{
    const double *P = self->S + self->pivot_at[k];
    double *own = x + self->at[k], here[ZD_UNROLLED], *scaled = uniform ? here : self->product;
    for (int e = self->begin[k]; e < self->begin[k + 1]; e++) {
        const int row = self->row[e], a = uniform ? n : size_at(self, row);
        subtract_times(a, n, self->S + self->entry_at[e], own, x + self->at[row]);
    }
    multiply(1, n, own, P, scaled);
    memcpy(own, scaled, (size_t)n * sizeof *own);
}

/* x_k <- x_k - sum L_i^T x_i */
ZD_INLINE void backward(const int n, const int uniform, const zd_blocks *self, int k, double *x)
{
    double *own = x + self->at[k];
    for (int e = self->begin[k]; e < self->begin[k + 1]; e++) {
        const int row = self->row[e], a = uniform ? n : size_at(self, row);
        const double *L = self->S + self->entry_at[e], *other = x + self->at[row];
        for (int i = 0; i < a; i++)
            for (int j = 0; j < n; j++) own[j] -= L[i * n + j] * other[i];
    }
}

#define FOR_KERNEL(step, k)                                            \
    switch (self->kernel[k]) {                                         \
    case 1: step(1, 1, self, k, x); break;                             \
    case 2: step(2, 1, self, k, x); break;                             \
    case 3: step(3, 1, self, k, x); break;                             \
    case 5: step(5, 1, self, k, x); break;                             \
    case 6: step(6, 1, self, k, x); break;                             \
    default: step(size_at(self, k), 0, self, k, x);                    \
    }

void zd_blocks_solve(const zd_blocks *self, double *x)
{
    for (int k = 0; k < self->count; k++) FOR_KERNEL(forward, k)
    for (int k = self->count - 1; k >= 0; k--) FOR_KERNEL(backward, k)
}
