/* Factorization of symmetric indefinite matrices; the upper triangle is stored, row after row. */
#ifndef ZD_SYMMETRIC_H
#define ZD_SYMMETRIC_H

#include <stddef.h>

static inline size_t zd_triangle(size_t n) { return n * (n + 1) / 2; }
/* The row whose entry j >= i is A_ij. */
static inline double *zd_triangle_row(int n, double *A, int i) { return A + (ptrdiff_t)i * n - (ptrdiff_t)i * (i + 1) / 2; }

/* Factors A in place, P A P^T = L D L^T, with blocks of D of one or two rows; order (n,). Returns n, or the step without a pivot. */
int zd_symmetric_factor(int n, double *A, int *order);
/* b <- A^-1 b */
void zd_symmetric_solve(int n, double *LD, const int *order, double *b);
/* Index of the last linearly dependent column, after `step` found no pivot; x (n,) is overwritten. */
int zd_symmetric_dependent(int n, double *LD, const int *order, int step, double *x);

#endif
