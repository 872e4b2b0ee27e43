/* S = L D L^T by scalar pivots, stored in the blocks of blocks.c: with L_k D_k L_k^T the diagonal block k and B_i those below it,
 *
 *     Y_i = B_i L_k^-T,        L_i = Y_i D_k^-1,        S_ij <- S_ij - Y_i L_j^T
 *
 * The inverse of a diagonal block would carry the rounding of its largest entries into all of its products. In M + C^T W C these entries
 * are of the order 1 / M, in the directions that constraints leave free; multiplied by W they would have to cancel.
 */
#include "blocks.h"

#include <string.h>

#include "../small.h"

/* P (n, n) <- its factors, the reciprocals of D on the diagonal. Returns n, or the row whose pivot is only rounding. */
static int factor_block(int n, const double *diagonal, double *P)
{
    for (int i = 0; i < n; i++)
        if (!zd_cholesky_row(n, i, 0, P, P) || !(1 > n * 0x1p-52 * diagonal[i] * P[i * n + i])) return i;
    return n;
}

/* to (a, b) <- to - A B^T, A (a, n), B (b, n) */
static void subtract_product(int a, int b, int n, const double *A, const double *B, double *to)
{
    for (int i = 0; i < a; i++)
        for (int j = 0; j < b; j++)
            for (int k = 0; k < n; k++) to[i * b + j] -= A[i * n + k] * B[j * n + k];
}

/* Column k; returns the row of its diagonal block at which it fails, or -1. */
static int eliminate(zd_blocks *self, int k)
{
    const int n = zd_block_size(self, k), first = self->begin[k];
    const int *target = self->target + self->target_begin[k];
    double *S = self->S, *P = S + self->pivot_at[k];
    const int failed = factor_block(n, self->diagonal + self->at[k], P);
    if (failed < n) return self->at[k] + failed;
    for (int e = first; e < self->begin[k + 1]; e++) {
        const int row = self->row[e], a = zd_block_size(self, row);
        double *B = S + self->entry_at[e], *Y = self->product;
        for (int i = 0; i < a; i++) zd_forward(n, P, B + i * n, Y + i * n);
        for (int i = 0; i < a; i++)
            for (int j = 0; j < n; j++) B[i * n + j] = Y[i * n + j] * P[j * n + j];
        for (int f = first; f < e; f++) subtract_product(a, zd_block_size(self, self->row[f]), n, Y, S + self->entry_at[f], S + *target++);
        subtract_product(a, a, n, Y, B, S + self->pivot_at[row]);
    }
    return -1;
}

int zd_triangular_factor(zd_blocks *self)
{
    int failed = -1;
    for (int k = 0; k < self->count; k++)
        for (int i = 0, n = zd_block_size(self, k); i < n; i++) self->diagonal[self->at[k] + i] = self->S[self->pivot_at[k] + i * (n + 1)];
    for (int k = 0; k < self->count && failed < 0; k++) failed = eliminate(self, k);
    return failed;
}

void zd_triangular_solve(const zd_blocks *self, double *x)
{
    for (int k = 0; k < self->count; k++) {
        const int n = zd_block_size(self, k);
        double *own = x + self->at[k];
        zd_forward(n, self->S + self->pivot_at[k], own, own);
        for (int e = self->begin[k]; e < self->begin[k + 1]; e++)
            for (int i = 0, a = zd_block_size(self, self->row[e]); i < a; i++)
                x[self->at[self->row[e]] + i] -= zd_dot(n, self->S + self->entry_at[e] + i * n, own);
    }
    for (int k = self->count - 1; k >= 0; k--) {
        const int n = zd_block_size(self, k);
        const double *P = self->S + self->pivot_at[k];
        double *own = x + self->at[k];
        for (int j = 0; j < n; j++) own[j] *= P[j * n + j];
        for (int e = self->begin[k]; e < self->begin[k + 1]; e++)
            for (int i = 0, a = zd_block_size(self, self->row[e]); i < a; i++)
                for (int j = 0; j < n; j++) own[j] -= self->S[self->entry_at[e] + i * n + j] * x[self->at[self->row[e]] + i];
        for (int i = n - 1; i > 0; i--)
            for (int j = 0; j < i; j++) own[j] -= P[i * n + j] * own[i];
    }
}
