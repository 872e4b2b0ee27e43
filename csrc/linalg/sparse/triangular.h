/* Block factors as in blocks.h, but with triangular factors of diagonal blocks: for ill-conditioned matrices, whose blocks must not be
 * inverted. */
#ifndef ZD_TRIANGULAR_H
#define ZD_TRIANGULAR_H

#include "blocks.h"

/* S <- its factors. Returns the first row, in the order of elimination, whose pivot is not positive, or -1. */
int zd_triangular_factor(zd_blocks *self);
/* x (rows,), in the order of elimination, <- S^-1 x */
void zd_triangular_solve(const zd_blocks *self, double *x);

#endif
