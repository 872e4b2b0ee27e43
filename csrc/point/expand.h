/* Conversion of packed matrices to dense ones. */
#ifndef ZD_EXPAND_H
#define ZD_EXPAND_H

#include "../zerodrift.h"

/* dense <- A (nq, nv), M (nv, nv) or C (m, nv), from the packed term of a system that declares its structure. */
void zd_expand(const zd_system *system, int term, const double *packed, double *dense);

#endif
