/* Packed matrices as dense ones: the only place where these are made. */
#ifndef ZD_EXPAND_H
#define ZD_EXPAND_H

#include "../zerodrift.h"

/* dense <- A (nq, nv), M (nv, nv) or C (m, nv), from what a system that declares its structure has written. */
void zd_expand(const zd_system *system, int term, const double *packed, double *dense);

#endif
