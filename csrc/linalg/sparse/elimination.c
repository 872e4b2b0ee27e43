/* Block L D L^T, right-looking: once the block row k is eliminated, with P = D_k^-1 and B_i the blocks below it,
 *
 *     S_ij <- S_ij - B_i P B_j^T
 *
 * with the offset of each S_ij from blocks.c. The B_i are stored, and L = B P is not. Diagonal blocks are inverted by scalar pivots, which
 * omitted rows do not have. A solution takes two products with each block, the first of which can be computed during the factorization:
 *
 *     forward     x_k <- P x_k,    x_i <- x_i - B_i x_k
 *     backward    x_k <- x_k - P sum_i B_i^T x_i
 *
 * Arguments of kernels known at compile time: `n` is the size of the pivot's block; `is_same`: all blocks of its column have this size;
 * `is_complete`: all blocks of the matrix have it, so that offsets follow from indices.
 */
#include <stddef.h>

#include "blocks.h"

#include "../small.h"

/* kernel(n, is_same, is_complete, ...), compiled for the common sizes */
#define FOR_SIZE(kernel, size, is_complete, ...)             \
    switch (size) {                                       \
    case 1: kernel(1, 1, is_complete, __VA_ARGS__); break;   \
    case 2: kernel(2, 1, is_complete, __VA_ARGS__); break;   \
    case 3: kernel(3, 1, is_complete, __VA_ARGS__); break;   \
    case 5: kernel(5, 1, is_complete, __VA_ARGS__); break;   \
    case 6: kernel(6, 1, is_complete, __VA_ARGS__); break;   \
    default: break;                                       \
    }

ZD_INLINE int at_of(const int n, const int is_complete, const zd_blocks *self, int k) { return is_complete ? n * k : self->at[k]; }

ZD_INLINE double *pivot_of(const int n, const int is_complete, const zd_blocks *self, int k)
{
    return self->S + (is_complete ? n * n * k : self->pivot_at[k]);
}

ZD_INLINE double *entry_of(const int n, const int is_complete, const zd_blocks *self, int e)
{
    return self->S + (is_complete ? n * n * (self->count + e) : self->entry_at[e]);
}

/* ---- factors ---- */

/* P (n, n) <- L^-T D^-1 L^-1, where its lower triangle is L D L^T; what is left out has no part in it. `row` is that of its first one. */
ZD_INLINE void invert(const int n, const zd_blocks *self, int row, double *P, unsigned char *left_out, double least, zd_pivots *pivots)
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
        const int is_pivot = !(left_out && left_out[row + i]) && zd_judge_pivot(pivots, row + i, pivot, self->diagonal[row + i], rounding);
        P[i * n + i] = is_pivot ? 1 / pivot : 0;
        for (int k = i + 1; k < n; k++) {
            double sum = P[k * n + i];
            for (int j = 0; j < i; j++) sum -= P[k * n + j] * P[i * n + j];
            P[k * n + i] = is_pivot ? sum : 0;      /* entry of L D, until it is inverted */
        }
    }
    zd_invert(n, P);
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

/* y (a,) <- y - B x, B (a, n) */
ZD_INLINE void subtract_times(const int a, const int n, const double *B, const double *x, double *y)
{
    for (int i = 0; i < a; i++) {
        double sum = y[i];
        for (int k = 0; k < n; k++) sum -= B[i * n + k] * x[k];
        y[i] = sum;
    }
}

/* x_k <- P x_k */
ZD_INLINE void scale(const int n, const int is_same, const zd_blocks *self, const double *P, double *own)
{
    double here[ZD_UNROLLED], *scaled = is_same ? here : self->product;
    multiply(1, n, own, P, scaled);
    zd_copy_all(n, scaled, own);
}

ZD_INLINE void eliminate(const int n, const int is_same, const int is_complete, const zd_blocks *self, int k, unsigned char *left_out,
                         double least, double *restrict x, zd_pivots *pivots)
{
    double *P = pivot_of(n, is_complete, self, k), *own = x ? x + at_of(n, is_complete, self, k) : NULL;
    double here[ZD_UNROLLED * ZD_UNROLLED], *product = is_same ? here : self->product;
    const int *target = self->target + self->target_begin[k], first = self->begin[k];
    invert(n, self, at_of(n, is_complete, self, k), P, left_out, least, pivots);
    if (x) scale(n, is_same, self, P, own);
    for (int e = first; e < self->begin[k + 1]; e++) {
        const int row = self->row[e], a = is_same ? n : zd_block_size(self, row);
        const double *B = entry_of(n, is_complete, self, e);
        multiply(a, n, B, P, product);
        for (int f = first; f < e; f++) {
            const int b = is_same ? n : zd_block_size(self, self->row[f]);
            subtract_product(a, b, n, product, entry_of(n, is_complete, self, f), self->S + *target++);
        }
        subtract_product(a, a, n, product, B, pivot_of(n, is_complete, self, row));
        if (x) subtract_times(a, n, B, own, x + at_of(n, is_complete, self, row));
    }
}

ZD_INLINE void eliminate_all(const int n, const int is_same, const int is_complete, const zd_blocks *self, double *restrict x,
                             zd_pivots *pivots)
{
    zd_pivots found = *pivots;              /* in registers */
    for (int k = 0; k < self->count; k++) eliminate(n, is_same, is_complete, self, k, NULL, 0, x, &found);
    *pivots = found;
}

/* to (2,) <- to - x */
ZD_INLINE void subtract_two(zd_two x, double *to)
{
    zd_store_two(zd_minus_two(zd_two_at(to), x), to);
}

/* to (2, 2) <- to - scale L B^T; l0, l1 are the columns of L, b0, b1 those of B */
ZD_INLINE void subtract_rows(double scale, zd_two l0, zd_two l1, zd_two b0, zd_two b1, double *to)
{
    subtract_two(zd_scaled_two(scale, zd_sum_of_two(zd_first_of(l0), b0, zd_first_of(l1), b1)), to);
    subtract_two(zd_scaled_two(scale, zd_sum_of_two(zd_second_of(l0), b0, zd_second_of(l1), b1)), to + 2);
}

/* Eliminates all blocks if each has two rows, with their loops unrolled. Both columns of a block are held as pairs. Products with the
 * inverse P are divided by its determinant last, as a division takes longest. `carries`: 1 if a right-hand side x is eliminated, too. */
ZD_INLINE void eliminate_twos(const int carries, const zd_blocks *self, double *restrict x,
                             zd_pivots *pivots)
{
    const int count = self->count, *begin = self->begin, *row = self->row, *target = self->target;
    double *S = self->S, *pivot = S, *entry = S + 4 * count;
    zd_pivots found = *pivots;              /* in registers */
    for (int k = 0; k < count; k++, pivot += 4) {
        const zd_inverse_of_two P = zd_invert_two(self->diagonal + 2 * k, 2 * k, pivot, &found);
        const double *first = entry, *end = entry + 4 * (begin[k + 1] - begin[k]);
        const zd_two P0 = zd_two_of(P.aa, P.ab), P1 = zd_two_of(P.ab, P.bb);
        zd_two y = P0;
        zd_store_two(zd_scaled_two(P.scale, P0), pivot);
        zd_store_two(zd_scaled_two(P.scale, P1), pivot + 2);
        if (carries) {
            double *own = x + 2 * k;
            y = zd_scaled_two(P.scale, zd_sum_of_two(own[0], P0, own[1], P1));
            zd_store_two(y, own);
        }
        for (; entry < end; entry += 4) {
            const zd_two b0 = zd_two_of(entry[0], entry[2]), b1 = zd_two_of(entry[1], entry[3]);
            const zd_two l0 = zd_sum_of_two(P.aa, b0, P.ab, b1), l1 = zd_sum_of_two(P.ab, b0, P.bb, b1);    /* B P, unscaled */
            const ptrdiff_t at = *row++;
            if (carries) subtract_two(zd_sum_of_two(zd_first_of(y), b0, zd_second_of(y), b1), x + 2 * at);
            subtract_rows(P.scale, l0, l1, b0, b1, S + 4 * at);
            for (const double *C = first; C < entry; C += 4)
                subtract_rows(P.scale, l0, l1, zd_two_of(C[0], C[2]), zd_two_of(C[1], C[3]), S + *target++);
        }
    }
    *pivots = found;
}

ZD_INLINE void keep_diagonals(const int n, const int is_same, const int is_complete, const zd_blocks *self)
{
    (void)is_same;
    for (int k = 0; k < self->count; k++)
        for (int i = 0; i < n; i++) self->diagonal[n * k + i] = pivot_of(n, is_complete, self, k)[i * (n + 1)];
}

static void keep_diagonals_of_any(const zd_blocks *self)
{
    for (int k = 0; k < self->count; k++) {
        const int n = zd_block_size(self, k);
        const double *P = self->S + self->pivot_at[k];
        for (int i = 0; i < n; i++) self->diagonal[self->at[k] + i] = P[i * (n + 1)];
    }
}

zd_pivots zd_blocks_factor(zd_blocks *self, unsigned char *left_out, double least, double *x)
{
    zd_pivots pivots = {-1, 0, 1, 1};
    if (self->uniform && !left_out) {
        FOR_SIZE(keep_diagonals, self->uniform, 1, self)
        if (self->uniform == 2 && x) eliminate_twos(1, self, x, &pivots);
        else if (self->uniform == 2) eliminate_twos(0, self, NULL, &pivots);
        else FOR_SIZE(eliminate_all, self->uniform, 1, self, x, &pivots)
        return pivots;
    }
    keep_diagonals_of_any(self);
    for (int k = 0; k < self->count; k++) {
        const int kernel = self->kernel[k];
        if (!kernel) eliminate(zd_block_size(self, k), 0, 0, self, k, left_out, least, x, &pivots);
        else if (left_out) FOR_SIZE(eliminate, kernel, 0, self, k, left_out, least, x, &pivots)
        else FOR_SIZE(eliminate, kernel, 0, self, k, NULL, 0, x, &pivots)
    }
    return pivots;
}

/* ---- solution ---- */

ZD_INLINE void forward(const int n, const int is_same, const int is_complete, const zd_blocks *self, int k, double *x)
{
    double *own = x + at_of(n, is_complete, self, k);
    scale(n, is_same, self, pivot_of(n, is_complete, self, k), own);
    for (int e = self->begin[k]; e < self->begin[k + 1]; e++) {
        const int row = self->row[e], a = is_same ? n : zd_block_size(self, row);
        subtract_times(a, n, entry_of(n, is_complete, self, e), own, x + at_of(n, is_complete, self, row));
    }
}

ZD_INLINE void backward(const int n, const int is_same, const int is_complete, const zd_blocks *self, int k, double *x)
{
    const double *P = pivot_of(n, is_complete, self, k);
    double *own = x + at_of(n, is_complete, self, k), here[ZD_UNROLLED], *sum = is_same ? here : self->product;
    for (int j = 0; j < n; j++) sum[j] = 0;
    for (int e = self->begin[k]; e < self->begin[k + 1]; e++) {
        const int row = self->row[e], a = is_same ? n : zd_block_size(self, row);
        const double *B = entry_of(n, is_complete, self, e), *other = x + at_of(n, is_complete, self, row);
        for (int i = 0; i < a; i++)
            for (int j = 0; j < n; j++) sum[j] += B[i * n + j] * other[i];
    }
    subtract_times(n, n, P, sum, own);
}

/* Forward substitution with blocks of two rows, as in eliminate_twos(). */
static void forward_twos(const zd_blocks *self, double *restrict x)
{
    const int count = self->count, *begin = self->begin, *row = self->row;
    const double *P = self->S, *B = P + 4 * count;
    double *own = x;
    for (int k = 0; k < count; k++, P += 4, own += 2) {
        const zd_two y = zd_sum_of_two(own[0], zd_two_at(P), own[1], zd_two_at(P + 2));
        zd_store_two(y, own);
        for (int below = begin[k + 1] - begin[k]; below; below--, B += 4) {
            const zd_two b0 = zd_two_of(B[0], B[2]), b1 = zd_two_of(B[1], B[3]);
            subtract_two(zd_sum_of_two(zd_first_of(y), b0, zd_second_of(y), b1), x + 2 * (ptrdiff_t)*row++);
        }
    }
}

static void backward_twos(const zd_blocks *self, double *restrict x)
{
    const int count = self->count, *begin = self->begin, *row = self->row + begin[count];
    const double *P = self->S + 4 * count, *B = P + 4 * begin[count];
    double *own = x + 2 * count;
    for (int k = count - 1; k >= 0; k--) {
        zd_two sum = zd_two_of(0, 0);
        for (int below = begin[k + 1] - begin[k]; below; below--) {
            const double *z = x + 2 * (ptrdiff_t)*--row;
            B -= 4;
            sum = zd_plus_two(sum, zd_sum_of_two(z[0], zd_two_at(B), z[1], zd_two_at(B + 2)));
        }
        P -= 4;
        own -= 2;
        subtract_two(zd_sum_of_two(zd_first_of(sum), zd_two_at(P), zd_second_of(sum), zd_two_at(P + 2)), own);
    }
}

ZD_INLINE void forward_all(const int n, const int is_same, const int is_complete, const zd_blocks *self, double *x)
{
    for (int k = 0; k < self->count; k++) forward(n, is_same, is_complete, self, k, x);
}

ZD_INLINE void backward_all(const int n, const int is_same, const int is_complete, const zd_blocks *self, double *x)
{
    for (int k = self->count - 1; k >= 0; k--) backward(n, is_same, is_complete, self, k, x);
}

void zd_blocks_forward(const zd_blocks *self, double *x)
{
    if (self->uniform == 2) forward_twos(self, x);
    else FOR_SIZE(forward_all, self->uniform, 1, self, x)
    for (int k = 0; !self->uniform && k < self->count; k++) {
        if (!self->kernel[k]) forward(zd_block_size(self, k), 0, 0, self, k, x);
        FOR_SIZE(forward, self->kernel[k], 0, self, k, x)
    }
}

void zd_blocks_backward(const zd_blocks *self, double *x)
{
    if (self->uniform == 2) backward_twos(self, x);
    else FOR_SIZE(backward_all, self->uniform, 1, self, x)
    for (int k = self->count - 1; !self->uniform && k >= 0; k--) {
        if (!self->kernel[k]) backward(zd_block_size(self, k), 0, 0, self, k, x);
        FOR_SIZE(backward, self->kernel[k], 0, self, k, x)
    }
}
