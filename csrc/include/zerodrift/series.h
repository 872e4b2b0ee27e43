/* Operations of generated Taylor series: sums over coefficients of lower orders, and one inverse for all orders.
 *
 * Sums are formed of eight products at once, with or without vectors of the processor: the results are the same on all vector units.
 *
 * The same source is compiled in double precision, or in double-double arithmetic where ZD_SERIES_DOUBLE_DOUBLE is defined: a zd_number is
 * one or the other. The leading matrix then is inverted in double precision, and each solution is refined.
 */
#ifndef ZERODRIFT_SERIES_H
#define ZERODRIFT_SERIES_H

#include <math.h>

#include "sines.h"

/* ZD_SERIES_UNIT: 1 and 2 are AVX2 and AVX-512, as in zd_unit */
#if defined(ZD_SERIES_UNIT) && ZD_SERIES_UNIT == 2 && defined(__GNUC__) && defined(__x86_64__)
#define ZD_SERIES_ON __attribute__((target("avx512f,avx512dq,avx512vl,avx2")))
#elif defined(ZD_SERIES_UNIT) && ZD_SERIES_UNIT == 1 && defined(__GNUC__) && defined(__x86_64__)
#define ZD_SERIES_ON __attribute__((target("avx2")))
#else
#define ZD_SERIES_ON
#endif

/* A step of Gauss and Jordan's elimination, in place. */
ZD_SERIES_ON static inline void zd_series_eliminate(const int size, double *restrict G, int k)
{
    const double share = 1 / G[k * size + k];
    G[k * size + k] = 1;
    for (int j = 0; j < size; j++) G[k * size + j] *= share;
    for (int i = 0; i < size; i++) {
        if (i == k) continue;
        const double factor = G[i * size + k];
        G[i * size + k] = 0;
        for (int j = 0; j < size; j++) G[i * size + j] -= factor * G[k * size + j];
    }
}

ZD_SERIES_ON static inline void zd_series_drop(const int size, double *restrict G, int k)
{
    for (int i = 0; i < size; i++) G[i * size + k] = G[k * size + i] = 0;
}

/* G <- inverse of the leading matrix of (8) with n velocities and m constraints. M is positive definite, and its Schur complement negative
 * definite, so that pivots need no ordering. A constraint whose relative pivot is rounding is redundant, and gets multiplier zero. Returns
 * nonzero if M is not positive definite. */
ZD_SERIES_ON static inline int zd_series_invert(const int n, const int m, double *restrict G, double *restrict size_of_row)
{
    const int size = n + m;
    const double rounding = 0x1p-40;
    for (int k = 0; k < n; k++) size_of_row[k] = G[k * size + k];
    for (int k = 0; k < n; k++) {
        if (!(G[k * size + k] > 0x1p-48 * size_of_row[k])) return 1;
        zd_series_eliminate(size, G, k);
    }
    for (int k = n; k < size; k++) size_of_row[k] = -G[k * size + k];
    for (int k = n; k < size; k++)
        if (-G[k * size + k] > rounding * size_of_row[k]) zd_series_eliminate(size, G, k);
        else size_of_row[k] = -1;
    for (int k = n; k < size; k++)
        if (size_of_row[k] < 0) zd_series_drop(size, G, k);
    return 0;
}

#ifdef ZD_SERIES_DOUBLE_DOUBLE
#if defined(ZD_SERIES_UNIT) && ZD_SERIES_UNIT > 0 && defined(__GNUC__) && defined(__x86_64__)
#define ZD_DD_ON __attribute__((target("avx2,fma")))
#define ZD_DD_HAS_FMA
#endif
#include "double_double.h"
#include "series_double_double.h"
#else

typedef double zd_number;
#define ZD_NUM(x) (x)
#define ZD_PAIR(high, low) (high)
#define ZD_ADD(a, b) ((a) + (b))
#define ZD_SUB(a, b) ((a) - (b))
#define ZD_MUL(a, b) ((a) * (b))
#define ZD_DIV(a, b) ((a) / (b))
#define ZD_NEG(a) (-(a))
#define ZD_ROOT(a) sqrt(a)
#define ZD_CALL(name) name
#define ZD_TURNS zd_sines
#define ZD_INVERSE(G, entries, matrix) double *const G = matrix     /* in place */
#define ZD_INVERT(n, m, matrix, G, sizes) zd_series_invert(n, m, G, sizes)
#define ZD_SOLVE(size, matrix, G, right, x) zd_series_solve(size, G, right, x)

/* Eight products side by side, as vectors of the unit or not */
enum { ZD_SERIES_TOGETHER = 8 };
#if defined(__GNUC__)
#if defined(ZD_SERIES_UNIT) && ZD_SERIES_UNIT == 2
#define ZD_SERIES_WIDTH 8
#elif defined(ZD_SERIES_UNIT) && ZD_SERIES_UNIT == 1
#define ZD_SERIES_WIDTH 4
#else
#define ZD_SERIES_WIDTH 2
#endif
typedef double zd_series_vector __attribute__((vector_size(8 * ZD_SERIES_WIDTH), aligned(8), may_alias));
#else
#define ZD_SERIES_WIDTH 1
typedef double zd_series_vector;
#endif
enum { ZD_SERIES_VECTORS = ZD_SERIES_TOGETHER / ZD_SERIES_WIDTH };

/* sum (rows,) <- sum_(0 < j < order) X_j Y_(order - j), of X, Y (orders, rows); rows is a multiple of eight */
ZD_SERIES_ON static inline void zd_series_sum(const int rows, int order, const double *restrict X, const double *restrict Y,
                                              double *restrict sum)
{
    for (int first = 0; first < rows; first += ZD_SERIES_TOGETHER) {
        zd_series_vector total[ZD_SERIES_VECTORS];
        for (int i = 0; i < ZD_SERIES_VECTORS; i++) total[i] = (zd_series_vector){0};
        const double *x = X + rows + first, *y = Y + (order - 1) * rows + first;
        for (int j = 1; j < order; j++, x += rows, y -= rows)
            for (int i = 0; i < ZD_SERIES_VECTORS; i++)
                total[i] += ((const zd_series_vector *)x)[i] * ((const zd_series_vector *)y)[i];
        for (int i = 0; i < ZD_SERIES_VECTORS; i++) ((zd_series_vector *)(sum + first))[i] = total[i];
    }
}

/* x <- G right, of a symmetric G (size, size) */
ZD_SERIES_ON static inline void zd_series_solve(const int size, const double *restrict G, const double *restrict right, double *restrict x)
{
    for (int i = 0; i < size; i++) x[i] = G[i] * right[0];
    for (int j = 1; j < size; j++)
        for (int i = 0; i < size; i++) x[i] += G[j * size + i] * right[j];
}

#endif
#endif
