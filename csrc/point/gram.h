/* Products of the rows of C with each other, where its structure is declared: only rows whose groups touch a block both have any. */
#ifndef ZD_GRAM_H
#define ZD_GRAM_H

#include "layout.h"

/* G (m, m), row k of it up to k <- Y W Y^T, Y being stored as C is, and W the diagonal (nv,), or the identity where it is NULL. */
void zd_gram(const zd_layout *layout, const double *Y, const double *W, double *G);

#endif
