/* The elimination of elimination.c where all blocks have two rows, as those of joints in the plane, each in one register. Nothing is contracted,
 * and sums are added up in the same order: the results have the same bits. */
#ifndef ZD_ELIMINATION_ON_AVX2_H
#define ZD_ELIMINATION_ON_AVX2_H

#include "blocks.h"

#if defined(__x86_64__) && defined(__GNUC__)
static inline int zd_is_on_avx2(const zd_blocks *self) { return self->uniform == 2 && self->unit >= ZD_AVX2; }
void zd_eliminate_on_avx2(const zd_blocks *self, zd_pivots *pivots);
void zd_solve_on_avx2(const zd_blocks *self, double *x);
#else
static inline int zd_is_on_avx2(const zd_blocks *self) { return (void)self, 0; }
static inline void zd_eliminate_on_avx2(const zd_blocks *self, zd_pivots *pivots) { (void)self, (void)pivots; }
static inline void zd_solve_on_avx2(const zd_blocks *self, double *x) { (void)self, (void)x; }
#endif

#endif
