/* Orthogonal transformations of matrices with few columns, stored by rows, `stride` apart. */
#ifndef ZD_FEW_COLUMNS_H
#define ZD_FEW_COLUMNS_H

/* Reflects the rows (rows, columns) such that the first column has its first entry only. work (columns,) */
void zd_reflect_column(int rows, int columns, int stride, double *A, double *work);
/* A (rows, columns) <- upper triangle with the same products of columns; returns the number of its rows. */
int zd_triangulate(int rows, int columns, int stride, double *A, double *work);
/* Singular value decomposition of the first n columns: these <- A V, whose columns are orthogonal; V (n, n); norm (n,): singular values,
 * decreasing. One-sided Jacobi method. */
void zd_orthogonalize_columns(int rows, int n, int stride, double *A, double *V, double *norm);

#endif
