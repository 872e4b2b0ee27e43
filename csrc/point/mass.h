/* Cholesky's factors of M, block by block where its structure is declared. */
#ifndef ZD_MASS_H
#define ZD_MASS_H

#include "point.h"

/* L, stored as M is, with the factors of zd_cholesky(). Returns nv, or the velocity at which M is found not positive definite. */
int zd_mass_factor(const zd_point *point, double *L);

/* x <- M^-1 y, from the factors of all blocks; x may be y */
void zd_mass_solve(const zd_layout *layout, const double *L, const double *y, double *x);

#endif
