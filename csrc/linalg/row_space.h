/* Minimum-norm solutions of linear equations whose rows may be redundant, by a complete orthogonal decomposition:
 * A = P [L; B] Q^T with an orthogonal Q, a lower triangular L with as many rows as are independent, and a permutation P that takes the
 * longest remaining row first. */
#ifndef ZD_ROW_SPACE_H
#define ZD_ROW_SPACE_H

#include "../workspace.h"

typedef struct zd_row_space {
    int n, most;            /* columns; most rows */
    int rows, rank;
    double *A;              /* (most, n): the rows; then L and B, and to the right of L the reflections that make Q */
    double *diagonal;       /* (n,): diagonal of L */
    double *factor;         /* (n,) 2 / v^T v of each reflection */
    double *norm;           /* (most,): norms of the rows without their components along earlier ones */
    int *order;             /* (most,) P */
    double *T, *y, *c;      /* (n, most), (n,), (most,) temporary */
} zd_row_space;

zd_row_space zd_row_space_create(zd_arena *arena, int most, int n);
/* Factors the first `rows` rows of A, n columns each. Rows are redundant if their remaining norm is at most `share` of the longest row, or
 * `least`. */
void zd_row_space_factor(zd_row_space *self, int rows, double share, double least);
/* x (n,) <- solution of A x = right with the smallest norm, or least squares where rows contradict each other */
void zd_row_space_solve(zd_row_space *self, const double *right, double *x);
void zd_row_space_turn(const zd_row_space *self, double *x);        /* x <- Q^T x: those from `rank` on are along the null space */
void zd_row_space_turn_back(const zd_row_space *self, double *x);   /* x <- Q x */

#endif
