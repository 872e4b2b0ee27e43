/* Gaussian elimination with partial pivoting of a complex matrix, whose real and imaginary parts are apart. */
#ifndef ZD_COMPLEX_LU_H
#define ZD_COMPLEX_LU_H

/* Factors the (n, n) matrix in place, P A = L U, the diagonal of U in reciprocals; order (n,). Returns n, or the column where no
 * pivot is left. */
int zd_complex_lu_factor(int n, double *re, double *im, int *order);
/* b <- A^-1 b */
void zd_complex_lu_solve(int n, const double *re, const double *im, const int *order, double *b_re, double *b_im);

#endif
