/* Block L D L^T, right-looking: once the block row k is eliminated, with P = D_k^-1 and B_i the blocks below it,
 *
 *     L_i = B_i P,        S_ij <- S_ij - B_i L_j^T,        S_ii <- S_ii - L_i B_i^T
 *
 * where each S_ij stands was found beforehand, see blocks.c. Diagonal blocks are inverted by scalar pivots: a row that is left out has none.
 * Solutions take two products with each block.
 *
 * Kernels are told what the compiler is to know. `n` is the size of the pivot's block; `is_same`: of all blocks of its column, too; `is_whole`:
 * of all blocks of the matrix, so that where they stand follows from their numbers.
 */
#include <math.h>

#include "blocks.h"
#include "pivot.h"

/* kernel(n, is_same, is_whole, ...), with sizes known to the compiler for which that is worth it */
#define FOR_SIZE(kernel, size, is_whole, ...)             \
    switch (size) {                                       \
    case 1: kernel(1, 1, is_whole, __VA_ARGS__); break;   \
    case 2: kernel(2, 1, is_whole, __VA_ARGS__); break;   \
    case 3: kernel(3, 1, is_whole, __VA_ARGS__); break;   \
    case 5: kernel(5, 1, is_whole, __VA_ARGS__); break;   \
    case 6: kernel(6, 1, is_whole, __VA_ARGS__); break;   \
    default: break;                                       \
    }

static int size_at(const zd_blocks *self, int k) { return self->at[k + 1] - self->at[k]; }

ZD_INLINE int at_of(const int n, const int is_whole, const zd_blocks *self, int k) { return is_whole ? n * k : self->at[k]; }

ZD_INLINE double *pivot_of(const int n, const int is_whole, const zd_blocks *self, int k)
{
    return self->S + (is_whole ? n * n * k : self->pivot_at[k]);
}

ZD_INLINE double *entry_of(const int n, const int is_whole, const zd_blocks *self, int e)
{
    return self->S + (is_whole ? n * n * (self->count + e) : self->entry_at[e]);
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
            P[k * n + i] = is_pivot ? sum : 0;      /* of L D, for now */
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

/* Column k of blocks of two rows, written out: where a compiler takes entries in pairs that were stored one by one, it waits for each. */
ZD_INLINE void eliminate_two(const int is_whole, const zd_blocks *self, int k, zd_pivots *pivots)
{
    const int first = self->begin[k], end = self->begin[k + 1], *target = self->target + self->target_begin[k], at = at_of(2, is_whole, self, k);
    double *pivot = pivot_of(2, is_whole, self, k);
    const zd_inverse_of_two P = zd_invert_two(self->diagonal + at, at, pivot, pivots);
    pivot[0] = P.aa;
    pivot[1] = pivot[2] = P.ab;
    pivot[3] = P.bb;
    for (int e = first; e < end; e++) {
        double *B = entry_of(2, is_whole, self, e), *D = pivot_of(2, is_whole, self, self->row[e]);
        const double b0 = B[0], b1 = B[1], b2 = B[2], b3 = B[3];
        const double l0 = b0 * P.aa + b1 * P.ab, l1 = b0 * P.ab + b1 * P.bb, l2 = b2 * P.aa + b3 * P.ab, l3 = b2 * P.ab + b3 * P.bb;
        for (int f = first; f < e; f++) {
            const double *L = entry_of(2, is_whole, self, f);
            double *to = self->S + *target++;
            to[0] -= b0 * L[0] + b1 * L[1];
            to[1] -= b0 * L[2] + b1 * L[3];
            to[2] -= b2 * L[0] + b3 * L[1];
            to[3] -= b2 * L[2] + b3 * L[3];
        }
        D[0] -= l0 * b0 + l1 * b1;
        D[2] -= l2 * b0 + l3 * b1;
        D[3] -= l2 * b2 + l3 * b3;
        B[0] = l0, B[1] = l1, B[2] = l2, B[3] = l3;
    }
}

ZD_INLINE void eliminate(const int n, const int is_same, const int is_whole, const zd_blocks *self, int k, unsigned char *left_out, double least,
                         zd_pivots *pivots)
{
    if (is_same && n == 2) {
        eliminate_two(is_whole, self, k, pivots);
        return;
    }
    double *P = pivot_of(n, is_whole, self, k), here[ZD_UNROLLED * ZD_UNROLLED], *product = is_same ? here : self->product;
    const int *target = self->target + self->target_begin[k], first = self->begin[k];
    invert(n, self, at_of(n, is_whole, self, k), P, left_out, least, pivots);
    for (int e = first; e < self->begin[k + 1]; e++) {
        const int row = self->row[e], a = is_same ? n : size_at(self, row);
        double *B = entry_of(n, is_whole, self, e);
        for (int f = first; f < e; f++) {
            const int b = is_same ? n : size_at(self, self->row[f]);
            subtract_product(a, b, n, B, entry_of(n, is_whole, self, f), self->S + *target++);
        }
        multiply(a, n, B, P, product);
        subtract_product(a, a, n, product, B, pivot_of(n, is_whole, self, row));
        memcpy(B, product, (size_t)(a * n) * sizeof *B);
    }
}

ZD_INLINE void eliminate_all(const int n, const int is_same, const int is_whole, const zd_blocks *self, zd_pivots *pivots)
{
    zd_pivots found = *pivots;              /* in registers */
    for (int k = 0; k < self->count; k++) eliminate(n, is_same, is_whole, self, k, NULL, 0, &found);
    *pivots = found;
}

ZD_INLINE void keep_diagonals(const int n, const int is_same, const int is_whole, const zd_blocks *self)
{
    (void)is_same;
    for (int k = 0; k < self->count; k++)
        for (int i = 0; i < n; i++) self->diagonal[n * k + i] = pivot_of(n, is_whole, self, k)[i * (n + 1)];
}

static void keep_diagonals_of_any(const zd_blocks *self)
{
    for (int k = 0; k < self->count; k++) {
        const int n = size_at(self, k);
        const double *P = self->S + self->pivot_at[k];
        for (int i = 0; i < n; i++) self->diagonal[self->at[k] + i] = P[i * (n + 1)];
    }
}

zd_pivots zd_blocks_factor(zd_blocks *self, unsigned char *left_out, double least)
{
    zd_pivots pivots = {-1, 0, 1, 1};
    if (self->uniform && !left_out) {
        FOR_SIZE(keep_diagonals, self->uniform, 1, self)
        FOR_SIZE(eliminate_all, self->uniform, 1, self, &pivots)
        return pivots;
    }
    keep_diagonals_of_any(self);
    for (int k = 0; k < self->count; k++) {
        const int kernel = left_out ? 0 : self->kernel[k];
        if (!kernel) eliminate(size_at(self, k), 0, 0, self, k, left_out, least, &pivots);
        FOR_SIZE(eliminate, kernel, 0, self, k, NULL, 0, &pivots)
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

ZD_INLINE void forward(const int n, const int is_same, const int is_whole, const zd_blocks *self, int k, double *x)
{
    double *own = x + at_of(n, is_whole, self, k), here[ZD_UNROLLED], *scaled = is_same ? here : self->product;
    for (int e = self->begin[k]; e < self->begin[k + 1]; e++) {
        const int row = self->row[e], a = is_same ? n : size_at(self, row);
        subtract_times(a, n, entry_of(n, is_whole, self, e), own, x + at_of(n, is_whole, self, row));
    }
    multiply(1, n, own, pivot_of(n, is_whole, self, k), scaled);
    memcpy(own, scaled, (size_t)n * sizeof *own);
}

/* x_k <- x_k - sum L_i^T x_i */
ZD_INLINE void backward(const int n, const int is_same, const int is_whole, const zd_blocks *self, int k, double *x)
{
    double *own = x + at_of(n, is_whole, self, k);
    for (int e = self->begin[k]; e < self->begin[k + 1]; e++) {
        const int row = self->row[e], a = is_same ? n : size_at(self, row);
        const double *L = entry_of(n, is_whole, self, e), *other = x + at_of(n, is_whole, self, row);
        for (int i = 0; i < a; i++)
            for (int j = 0; j < n; j++) own[j] -= L[i * n + j] * other[i];
    }
}

ZD_INLINE void solve_two(const zd_blocks *self, double *x)
{
    for (int k = 0; k < self->count; k++) {
        const double *P = pivot_of(2, 1, self, k), x0 = x[2 * k], x1 = x[2 * k + 1];
        for (int e = self->begin[k]; e < self->begin[k + 1]; e++) {
            const double *L = entry_of(2, 1, self, e);
            double *y = x + 2 * self->row[e];
            y[0] -= L[0] * x0 + L[1] * x1;
            y[1] -= L[2] * x0 + L[3] * x1;
        }
        x[2 * k] = P[0] * x0 + P[2] * x1;
        x[2 * k + 1] = P[2] * x0 + P[3] * x1;
    }
    for (int k = self->count - 1; k >= 0; k--) {
        double x0 = x[2 * k], x1 = x[2 * k + 1];
        for (int e = self->begin[k]; e < self->begin[k + 1]; e++) {
            const double *L = entry_of(2, 1, self, e), *y = x + 2 * self->row[e];
            x0 -= L[0] * y[0] + L[2] * y[1];
            x1 -= L[1] * y[0] + L[3] * y[1];
        }
        x[2 * k] = x0;
        x[2 * k + 1] = x1;
    }
}

ZD_INLINE void solve_all(const int n, const int is_same, const int is_whole, const zd_blocks *self, double *x)
{
    for (int k = 0; k < self->count; k++) forward(n, is_same, is_whole, self, k, x);
    for (int k = self->count - 1; k >= 0; k--) backward(n, is_same, is_whole, self, k, x);
}

void zd_blocks_solve(const zd_blocks *self, double *x)
{
    if (self->uniform) {
        if (self->uniform == 2) solve_two(self, x);
        else FOR_SIZE(solve_all, self->uniform, 1, self, x)
        return;
    }
    for (int k = 0; k < self->count; k++) {
        if (!self->kernel[k]) forward(size_at(self, k), 0, 0, self, k, x);
        FOR_SIZE(forward, self->kernel[k], 0, self, k, x)
    }
    for (int k = self->count - 1; k >= 0; k--) {
        if (!self->kernel[k]) backward(size_at(self, k), 0, 0, self, k, x);
        FOR_SIZE(backward, self->kernel[k], 0, self, k, x)
    }
}
