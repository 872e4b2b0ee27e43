/* Newton's matrices of Radau's method, where a state (p, v) lets them have half its size. */
#ifndef ZD_RADAU_PAIRS_H
#define ZD_RADAU_PAIRS_H

#include "matrices.h"

/* 0 where the matrix is singular. */
int zd_radau_pairs_factor_real(zd_radau_matrices *self, double h);
int zd_radau_pairs_factor_complex(zd_radau_matrices *self, double h);
/* As zd_radau_solve_real and zd_radau_solve_complex */
void zd_radau_pairs_solve_real(const zd_radau_matrices *self, double *x);
void zd_radau_pairs_solve_complex(const zd_radau_matrices *self, double *x, double *y);

#endif
