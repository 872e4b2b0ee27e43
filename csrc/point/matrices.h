/* A, M and C at a point, wherever their entries are stored: dense, or packed as the structure of the system says. All that is not a
 * factorization goes through these. */
#ifndef ZD_MATRICES_H
#define ZD_MATRICES_H

#include "point.h"

/* Row k of entries that are stored as those of the point's C are: its own, or a copy. */
zd_row_of_C zd_row_in(const zd_point *point, const double *C, int k);
static inline zd_row_of_C zd_point_row(const zd_point *point, int k) { return zd_row_in(point, point->terms.C, k); }
/* Row k of those that count, the first point->rows. */
zd_row_of_C zd_counted_row(const zd_point *point, int k);
double zd_row_times(const zd_row_of_C *row, const double *x);       /* x (nv,) */
double zd_row_product(const zd_row_of_C *a, const zd_row_of_C *b);
void zd_row_expand(const zd_row_of_C *row, int n, double *x);       /* x (n,) <- the row with its zeros */
void zd_add_C(const zd_point *point, double weight, double *C);     /* C (m, nv) <- C + weight times the point's */

int zd_point_need_times_C(zd_point *point);         /* what the next one needs of C: its entries, or that the system knows where it is */
void zd_point_velocity_violation(const zd_point *point, double *Psi);       /* (5); needs these, Phi_t */
/* Has the terms in `want` computed, and what the next one needs of A: its entries, or that the system knows where it is. */
int zd_point_need_times_A(zd_point *point, int want);
void zd_point_rate(const zd_point *point, const double *v, double *pdot);   /* (1); needs these */
double zd_point_kinetic(const zd_point *point);     /* needs M */
/* y (nv,) <- M x; M is stored as the point's is. */
void zd_times_M(const zd_point *point, const double *M, const double *x, double *y);
double zd_times_M_times(const zd_point *point, const double *M, const double *x);       /* x^T M x */
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
/* Of the identity, where the system has no A. */
static inline double zd_entry_of_A(const zd_point *point, int i, int j)
{
    const double *A = point->terms.A;
    return !A ? i == j : point->layout ? zd_packed_entry_of_A(point->layout, A, i, j) : A[i * point->system->nv + j];
}

/* For what needs dense matrices: M (nv, nv) and the rows of C that count (rows, nv), which are the point's own, or where these are packed,
 * expanded into `memory`. */
const double *zd_dense_M(const zd_point *point, double *memory);
const double *zd_dense_C(const zd_point *point, double *memory);

#endif
