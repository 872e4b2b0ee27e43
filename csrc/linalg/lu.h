/* Gaussian elimination with partial pivoting. */
#ifndef ZD_LU_H
#define ZD_LU_H

/* Factors the (n, n) matrix in place, P A = L U, the diagonal of U in reciprocals; order (n,). Returns n, or the column where
 * no pivot is left. */
int zd_lu_factor(int n, double *A, int *order);
/* b <- A^-1 b */
void zd_lu_solve(int n, const double *LU, const int *order, double *b);
/* b <- A^-T b */
void zd_lu_solve_transposed(int n, const double *LU, const int *order, double *b);
double zd_lu_determinant(int n, const double *LU, const int *order);
/* Complete pivoting, to choose a basis: order (columns,) gets first `rows` independent columns of the (rows, columns) matrix A,
 * as well conditioned as they come, then the others. The first `leading` columns are taken before any other. A is destroyed.
 * Returns the rank found. */
int zd_choose_columns(int rows, int columns, int leading, double *A, int *order);

#endif
