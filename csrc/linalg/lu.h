/* Gaussian elimination with partial pivoting. */
#ifndef ZD_LU_H
#define ZD_LU_H

/* Factors the (n, n) matrix in place, P A = L U; order (n,). Returns n, or the column where no pivot is left. */
int zd_lu_factor(int n, double *A, int *order);
/* b <- A^-1 b */
void zd_lu_solve(int n, const double *LU, const int *order, double *b);

#endif
