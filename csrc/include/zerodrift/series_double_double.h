/* Operations of generated Taylor series in double-double arithmetic: see series.h, which includes this file. */
#ifndef ZERODRIFT_SERIES_DOUBLE_DOUBLE_H
#define ZERODRIFT_SERIES_DOUBLE_DOUBLE_H

#undef ZD_SERIES_ON
#define ZD_SERIES_ON ZD_DD_ON

typedef zd_double_double zd_number;
#define ZD_NUM(x) zd_dd_of(x)
#define ZD_PAIR(high, low) ((zd_number){high, low})
#define ZD_ADD zd_dd_plus
#define ZD_SUB zd_dd_minus
#define ZD_MUL zd_dd_times
#define ZD_DIV zd_dd_over
#define ZD_NEG zd_dd_negative
#define ZD_ROOT zd_dd_root
#define ZD_CALL(name) zd_dd_##name
#define ZD_TURNS zd_series_turns
#define ZD_INVERSE(G, entries, matrix) double G[entries]
#define ZD_INVERT zd_series_invert_rounded
#define ZD_SOLVE zd_series_solve_refined

enum { ZD_SERIES_TOGETHER = 1, ZD_SERIES_REFINEMENTS = 8, ZD_SERIES_LEAST_REFINEMENTS = 2 };

ZD_DD_INLINE void zd_series_turns(int count, const zd_number *angle, zd_number *sine, zd_number *cosine)
{
    for (int i = 0; i < count; i++) zd_dd_turn(angle[i], sine + i, cosine + i);
}

/* sum (rows,) <- sum_(0 < j < order) X_j Y_(order - j), of X, Y (orders, rows) */
ZD_DD_RARE void zd_series_sum(int rows, int order, const zd_number *X, const zd_number *Y, zd_number *sum)
{
    for (int i = 0; i < rows; i++) sum[i] = zd_dd_of(0);
    for (int j = 1; j < order; j++) {
        const zd_number *x = X + j * rows, *y = Y + (order - j) * rows;
        for (int i = 0; i < rows; i++) sum[i] = zd_dd_plus(sum[i], zd_dd_times(x[i], y[i]));
    }
}

/* G <- inverse of the matrix, rounded: see zd_series_invert() */
ZD_DD_RARE int zd_series_invert_rounded(int n, int m, const zd_number *matrix, double *G, double *sizes)
{
    for (int i = 0; i < (n + m) * (n + m); i++) G[i] = matrix[i].high;
    return zd_series_invert(n, m, G, sizes);
}

/* x += G (right - matrix x). Returns the largest change, relative to the largest |x|. */
ZD_DD_RARE double zd_series_refine(int size, const zd_number *matrix, const double *G, const zd_number *right, zd_number *x)
{
    double largest = 0, change = 0, left[ZD_SERIES_SIZE];
    for (int i = 0; i < size; i++) {
        zd_number residual = right[i];
        for (int j = 0; j < size; j++) residual = zd_dd_minus(residual, zd_dd_times(matrix[i * size + j], x[j]));
        left[i] = residual.high;
    }
    for (int i = 0; i < size; i++) {
        double more = 0;
        for (int j = 0; j < size; j++) more += G[i * size + j] * left[j];
        x[i] = zd_dd_plus(x[i], zd_dd_of(more));
        change = fmax(change, fabs(more));
        largest = fmax(largest, fabs(x[i].high));
    }
    return largest > 0 ? change / largest : 0;
}

/* Solution of matrix x = right: by the inverse G in double precision, and refined at least twice. */
ZD_DD_RARE void zd_series_solve_refined(int size, const zd_number *matrix, const double *G, const zd_number *right, zd_number *x)
{
    for (int i = 0; i < size; i++) x[i] = zd_dd_of(0);
    for (int k = 0; k <= ZD_SERIES_REFINEMENTS; k++) {
        const double change = zd_series_refine(size, matrix, G, right, x);
        if (k >= ZD_SERIES_LEAST_REFINEMENTS && change <= 0x1p-104) return;
    }
}

/* to (n,) <- sum_k x_k h^k of coefficients x (order + 1, n), pairs of doubles all */
ZD_DD_RARE void zd_series_value(int order, int n, const double *x, const double *h, double *to)
{
    const zd_number *coefficient = (const zd_number *)x, by = {h[0], h[1]};
    zd_number *sum = (zd_number *)to;
    for (int i = 0; i < n; i++) sum[i] = coefficient[order * n + i];
    for (int k = order - 1; k >= 0; k--)
        for (int i = 0; i < n; i++) sum[i] = zd_dd_plus(zd_dd_times(sum[i], by), coefficient[k * n + i]);
}

#endif
