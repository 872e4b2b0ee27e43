/* With S = L D L^T by blocks, P_k = D_k^-1 and L_ik = B_i P_k, see elimination.c, blocks of Z = S^-1 follow from those of later columns,
 * and those alone that are in the pattern (Takahashi, Fagan and Chen 1973):
 *
 *     U_i = sum_j Z_ij B_j,    Z_ik = -U_i P_k,    Z_kk = P_k + P_k (sum_i B_i^T U_i) P_k
 *
 * over the block rows i, j below the diagonal block of column k.
 */

#include "../small.h"
#include "blocks.h"

#include "../small.h"

/* to (a, n) <- to + A B, B (b, n); A (a, b) or, where it is turned, the transpose of what is given */
ZD_INLINE void add_product(const int a, const int b, const int n, int is_turned, const double *A, const double *B, double *to)
{
    const int down = is_turned ? 1 : b, along = is_turned ? a : 1;
    for (int i = 0; i < a; i++)
        for (int j = 0; j < n; j++) {
            double sum = to[i * n + j];
            for (int l = 0; l < b; l++) sum += A[i * down + l * along] * B[l * n + j];
            to[i * n + j] = sum;
        }
}

/* to (a, n) <- sign U P; P (n, n) is symmetric, and only its upper triangle is read */
ZD_INLINE void scale(const int a, const int n, double sign, const double *U, const double *P, double *to)
{
    for (int i = 0; i < a; i++)
        for (int j = 0; j < n; j++) {
            double sum = 0;
            for (int l = 0; l < n; l++) sum += U[i * n + l] * (l < j ? P[l * n + j] : P[j * n + l]);
            to[i * n + j] = sign * sum;
        }
}

/* U (a, n) <- sum_j Z_ij B_j of the entry e of column k */
ZD_INLINE void gather(const int n, const int is_same, const zd_blocks *self, const double *Z, int k, int e, double *U)
{
    const int first = self->begin[k], a = is_same ? n : zd_block_size(self, self->row[e]);
    const int *target = self->target + self->target_begin[k];
    zd_clear(a * n, U);
    for (int f = first; f < self->begin[k + 1]; f++) {
        const int b = is_same ? n : zd_block_size(self, self->row[f]), late = (f > e ? f : e) - first, early = (f > e ? e : f) - first;
        const int at = e == f ? self->pivot_at[self->row[e]] : target[late * (late - 1) / 2 + early];
        add_product(a, b, n, f > e, Z + at, self->S + self->entry_at[f], U);
    }
}

ZD_INLINE void invert_column(const int n, const int is_same, const zd_blocks *self, double *Z, int k)
{
    double *own = Z + self->pivot_at[k], *U = self->product;
    const double *P = self->S + self->pivot_at[k];
    zd_clear(n * n, own);
    for (int e = self->begin[k]; e < self->begin[k + 1]; e++) {
        const int a = is_same ? n : zd_block_size(self, self->row[e]);
        gather(n, is_same, self, Z, k, e, U);
        add_product(n, a, n, 1, self->S + self->entry_at[e], U, own);
        scale(a, n, -1, U, P, Z + self->entry_at[e]);
    }
    scale(n, n, 1, own, P, U);
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++) {
            double sum = i < j ? P[i * n + j] : P[j * n + i];
            for (int l = 0; l < n; l++) sum += (l < i ? P[l * n + i] : P[i * n + l]) * U[l * n + j];
            own[i * n + j] = sum;
        }
}

void zd_blocks_invert(const zd_blocks *self, double *Z)
{
    for (int k = self->count - 1; k >= 0; k--) {
        if (self->uniform == 2) invert_column(2, 1, self, Z, k);
        else invert_column(zd_block_size(self, k), 0, self, Z, k);
    }
}
