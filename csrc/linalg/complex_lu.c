#include "dense.h"

#include <math.h>

#include "small.h"

/* Not the modulus, but within sqrt(2) of it, which is enough to compare pivots by */
ZD_INLINE double size_of(double re, double im) { return fabs(re) + fabs(im); }

ZD_INLINE void swap(double *a, double *b)
{
    double x = *a;
    *a = *b;
    *b = x;
}

ZD_INLINE int largest_below(const int n, const double *re, const double *im, int column)
{
    int best = column;
    for (int i = column + 1; i < n; i++)
        if (size_of(re[i * n + column], im[i * n + column]) > size_of(re[best * n + column], im[best * n + column])) best = i;
    return best;
}

/* (re, im) <- 1 / (re + i im), without overflow on the way */
ZD_INLINE void invert(double *re, double *im)
{
    const double size = size_of(*re, *im), a = *re / size, b = *im / size, norm = (a * a + b * b) * size;
    *re = a / norm;
    *im = -b / norm;
}

ZD_INLINE void eliminate(const int n, double *re, double *im, int k)
{
    const double *pivot_re = re + k * n, *pivot_im = im + k * n;
    for (int i = k + 1; i < n; i++) {
        double *row_re = re + i * n, *row_im = im + i * n;
        const double a = row_re[k] * pivot_re[k] - row_im[k] * pivot_im[k], b = row_re[k] * pivot_im[k] + row_im[k] * pivot_re[k];
        row_re[k] = a;
        row_im[k] = b;
        for (int j = k + 1; j < n; j++) {
            row_re[j] -= a * pivot_re[j] - b * pivot_im[j];
            row_im[j] -= a * pivot_im[j] + b * pivot_re[j];
        }
    }
}

ZD_INLINE int factor(const int n, double *re, double *im, int *order)
{
    const double negligible = n * 0x1p-52 * fmax(zd_largest(n * n, re), zd_largest(n * n, im));
    for (int k = 0; k < n; k++) {
        const int row = order[k] = largest_below(n, re, im, k);
        for (int j = 0; row != k && j < n; j++) {
            swap(re + k * n + j, re + row * n + j);
            swap(im + k * n + j, im + row * n + j);
        }
        if (!(size_of(re[k * n + k], im[k * n + k]) > negligible)) return k;
        invert(re + k * n + k, im + k * n + k);
        eliminate(n, re, im, k);
    }
    return n;
}

int zd_complex_lu_factor(int n, double *re, double *im, int *order)
{
    return ZD_SIZED(factor, n, re, im, order);
}

ZD_INLINE void solve(const int n, const double *re, const double *im, const int *order, double *b_re, double *b_im)
{
    for (int k = 0; k < n; k++) {
        swap(b_re + k, b_re + order[k]);
        swap(b_im + k, b_im + order[k]);
    }
    for (int i = 0; i < n; i++)
        for (int j = 0; j < i; j++) {
            b_re[i] -= re[i * n + j] * b_re[j] - im[i * n + j] * b_im[j];
            b_im[i] -= re[i * n + j] * b_im[j] + im[i * n + j] * b_re[j];
        }
    for (int i = n - 1; i >= 0; i--) {
        double a = b_re[i], b = b_im[i];
        for (int j = i + 1; j < n; j++) {
            a -= re[i * n + j] * b_re[j] - im[i * n + j] * b_im[j];
            b -= re[i * n + j] * b_im[j] + im[i * n + j] * b_re[j];
        }
        b_re[i] = a * re[i * n + i] - b * im[i * n + i];
        b_im[i] = a * im[i * n + i] + b * re[i * n + i];
    }
}

void zd_complex_lu_solve(int n, const double *re, const double *im, const int *order, double *b_re, double *b_im)
{
    ZD_SIZED(solve, n, re, im, order, b_re, b_im);
}
