/* Minimum-norm solutions of sparse linear equations by orthogonal transformations. */
#pragma once

/* Orthogonal transformations of matrices with few columns, stored by rows, `stride` apart. */

/* Reflects the rows (rows, columns) such that the first column has its first entry only. work (columns,) */
void zd_reflect_column(int rows, int columns, int stride, double *A, double *work);
/* A (rows, columns) <- upper triangle with the same products of columns; returns the number of its rows. */
int zd_triangulate(int rows, int columns, int stride, double *A, double *work);
/* Singular value decomposition of the first n columns: these <- A V, whose columns are orthogonal; V (n, n); norm (n,): singular values,
 * decreasing. One-sided Jacobi method. */
void zd_orthogonalize_columns(int rows, int n, int stride, double *A, double *V, double *norm);

/* Minimum-norm solutions of sparse linear equations by block elimination with orthogonal transformations. */

/* Nonzero entries of a row: x (count,), in the columns `column` (count,), which increase; column NULL: in all columns */
typedef struct zd_sparse_row {
    double *x;
    int count;
    const int *column;      /* rows with the same blocks may share it */
} zd_sparse_row;

/* Equations of unknowns in small blocks. Rows are multiplied by a factor, and columns divided by a weight. */
typedef struct zd_sparse_equations {
    int blocks;
    const int *at;          /* (blocks + 1,): offsets of the blocks in the unknowns */
    const int *block_of;    /* (unknowns,): block of each */
    int rows;
    const zd_sparse_row *row;   /* (rows,) */
    const double *right;    /* (rows,), multiplied by the factor, too */
    const double *factor;   /* (rows,): such that required rows have a length of about one */
    const unsigned char *is_square;     /* (rows,): 1 if the square of the residual is minimized; 0: required, met exactly */
    const double *weight;   /* (unknowns,); NULL: ones */
} zd_sparse_equations;

/* x (unknowns,) <- minimizer of the sum of (weight x)^2 and of the squares, under all required rows. These may be redundant; if they
 * contradict each other, their squared residuals are minimized. Returns ZD_DONE, or ZD_NO_MEMORY. */
int zd_minimum_norm(const zd_sparse_equations *equations, double *x);
