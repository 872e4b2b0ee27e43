/* Entries of A, M and C at a point, and products with them, for dense and packed storage. All code except factorizations uses these. */
#ifndef ZD_MATRICES_H
#define ZD_MATRICES_H

#include "point.h"

/* Row k of a matrix stored as the point's C. */
zd_row_of_C zd_row_in(const zd_point *point, const double *C, int k);
static inline zd_row_of_C zd_point_row(const zd_point *point, int k) { return zd_row_in(point, point->terms.C, k); }
/* Row of the k-th independent constraint, k < point->rows. */
zd_row_of_C zd_counted_row(const zd_point *point, int k);
double zd_row_times(const zd_row_of_C *row, const double *x);       /* x (nv,) */
double zd_row_product(const zd_row_of_C *a, const zd_row_of_C *b);
void zd_row_expand(const zd_row_of_C *row, int n, double *x);       /* x (n,) <- the row with its zeros */
void zd_add_C(const zd_point *point, double weight, double *C);     /* C (m, nv) <- C + weight times the point's */

int zd_point_need_times_C(zd_point *point);         /* evaluates the entries of C, or prepares the system's own products with C */
void zd_point_velocity_violation(const zd_point *point, double *Psi);       /* (5); requires zd_point_need_times_C() and Phi_t */
/* Evaluates the terms in `want`, and the entries of A, or prepares the system's own products with A. */
int zd_point_need_times_A(zd_point *point, int want);
void zd_point_rate(const zd_point *point, const double *v, double *pdot);   /* (1); requires zd_point_need_times_A() */
double zd_point_kinetic(const zd_point *point);     /* J: kinetic energy; requires M */
/* y (nv,) <- M x; M stored as the point's. */
void zd_times_M(const zd_point *point, const double *M, const double *x, double *y);
double zd_packed_entry_of_M(const zd_layout *layout, const double *M, int i, int j);
static inline double zd_entry_of_M(const zd_point *point, int i, int j)
{
    const double *M = point->terms.M;
    return point->layout ? zd_packed_entry_of_M(point->layout, M, i, j) : M[i * point->system->nv + j];
}
/* The first velocity for which row i of M has an entry. */
static inline int zd_first_in_M(const zd_point *point, int i)
{
    const zd_layout *layout = point->layout;
    return !layout ? 0 : layout->is_diagonal[layout->block_of[i]] ? i : layout->velocity_at[layout->block_of[i]];
}
double zd_packed_entry_of_A(const zd_layout *layout, const double *A, int i, int j);
/* Entry of A, the identity if the system has none. */
static inline double zd_entry_of_A(const zd_point *point, int i, int j)
{
    const double *A = point->terms.A;
    return !A ? i == j : point->layout ? zd_packed_entry_of_A(point->layout, A, i, j) : A[i * point->system->nv + j];
}

/* Dense M (nv, nv), and dense independent rows of C (rows, nv): the point's own, or expanded into `memory` if packed. */
const double *zd_dense_M(const zd_point *point, double *memory);
const double *zd_dense_C(const zd_point *point, double *memory);

#endif
