/* Factorizations of dense matrices. */
#pragma once

#include <stddef.h>

#include "../workspace.h"

/* Gaussian elimination with partial pivoting. */

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

/* Gaussian elimination with partial pivoting of a complex matrix, whose real and imaginary parts are apart. */

/* Factors the (n, n) matrix in place, P A = L U, the diagonal of U in reciprocals; order (n,). Returns n, or the column where no
 * pivot is left. */
int zd_complex_lu_factor(int n, double *re, double *im, int *order);
/* b <- A^-1 b */
void zd_complex_lu_solve(int n, const double *re, const double *im, const int *order, double *b_re, double *b_im);

/* Factorization of symmetric indefinite matrices; the upper triangle is stored, row after row. */

static inline size_t zd_triangle(size_t n) { return n * (n + 1) / 2; }
/* The row whose entry j >= i is A_ij. */
static inline double *zd_triangle_row(int n, double *A, int i) { return A + (ptrdiff_t)i * n - (ptrdiff_t)i * (i + 1) / 2; }

/* Factors A in place, P A P^T = L D L^T, with blocks of D of one or two rows; order (n,). Returns n, or the step without a pivot. */
int zd_symmetric_factor(int n, double *A, int *order);
/* b <- A^-1 b */
void zd_symmetric_solve(int n, double *LD, const int *order, double *b);
/* Index of the last linearly dependent column, after `step` found no pivot; x (n,) is overwritten. */
int zd_symmetric_dependent(int n, double *LD, const int *order, int step, double *x);

/* Orthogonalization of the rows of a matrix, in their order. */

typedef struct zd_orthogonal {
    int n, m;
    const double *L;        /* (n, n): factors by zd_cholesky() of the matrix whose inverse is the metric; NULL: Euclidean metric */
    double *Q;              /* (m, n): orthogonal rows, C = G Q in the Euclidean metric, otherwise C L^-T = G Q; input: the previous ones */
    double *G;              /* (m, m): unit lower triangular; its diagonal stores the inverse squared norms of the rows of Q */
    double *square;         /* (m,): squared norms of the rows of C, in the metric */
    double *rows;           /* (4, n): rows in process */
    double *weighted;       /* (n,) temporary */
} zd_orthogonal;

typedef struct zd_shares {
    int rows;               /* m, or the first row whose squared relative residual norm is below `enough` */
    double least;           /* smallest squared relative residual norm: |row of Q|^2 / |row of C|^2 */
    double turned;          /* sum of sin^2 of the angles between rows of Q and the previous ones; infinite at a right angle */
} zd_shares;

/* `enough`: squared relative residual norm that each row must have. */
zd_shares zd_orthogonalize(const zd_orthogonal *self, const double *C, double enough);

/* Minimum-norm solutions of linear equations whose rows may be redundant, by a complete orthogonal decomposition:
 * A = P [L; B] Q^T with an orthogonal Q, a lower triangular L with as many rows as are independent, and a permutation P that takes the
 * longest remaining row first. */

typedef struct zd_row_space {
    int n, most;            /* columns; most rows */
    int rows, rank;
    double *A;              /* (most, n): the rows; then L and B, and to the right of L the reflections that make Q */
    double *diagonal;       /* (n,): diagonal of L */
    double *factor;         /* (n,) 2 / v^T v of each reflection */
    double *norm;           /* (most,): norms of the rows without their components along earlier ones */
    int *order;             /* (most,) P */
    double *T, *y, *c;      /* (n, most), (n,), (most,) temporary; T has the factors of zd_lu_factor() if is_square */
    int is_square;          /* true if factored by zd_row_space_prepare(), with as many rows as columns, far from singular */
    double pivot;           /* set by that: the smallest pivot relative to the largest; 0 if the rank is below n */
} zd_row_space;

zd_row_space zd_row_space_create(zd_arena *arena, int most, int n);
/* Factors the first `rows` rows of A, n columns each. Rows are redundant if their remaining norm is at most `share` of the longest row, or
 * `least`. */
void zd_row_space_factor(zd_row_space *self, int rows, double share, double least);
/* The same for solutions alone. */
void zd_row_space_prepare(zd_row_space *self, int rows, double share, double least);
/* x (n,) <- solution of A x = right with the smallest norm, or least squares where rows contradict each other */
void zd_row_space_solve(zd_row_space *self, const double *right, double *x);
void zd_row_space_turn(const zd_row_space *self, double *x);        /* x <- Q^T x: those from `rank` on are along the null space */
void zd_row_space_turn_back(const zd_row_space *self, double *x);   /* x <- Q x */
