/* The factors of Newton's iteration in radau.c, of matrices as large as the state or, as pairs.c has them, half of that. */
#ifndef ZD_RADAU_FACTORS_H
#define ZD_RADAU_FACTORS_H

#include "matrices.h"

/* For steps of size h; ZD_NO_STEP where a matrix is singular. */
int zd_radau_factor_real(zd_radau_matrices *self, double h);
int zd_radau_factor(zd_radau_matrices *self, double h);
/* x (size,) <- (gamma / h - J)^-1 x */
void zd_radau_solve_real(const zd_radau_matrices *self, double *x);
/* x + i y (size,) <- ((alpha - i beta) / h - J)^-1 (x + i y) */
void zd_radau_solve_complex(const zd_radau_matrices *self, double *x, double *y);

#endif
