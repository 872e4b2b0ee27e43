/* Small dense kernels. Each takes its size as an argument and is always inlined, so that ZD_SIZED can call it with a
 * constant: for up to six unknowns the compiler then unrolls everything, beyond that the loops are ordinary ones.
 */
#ifndef ZD_SMALL_H
#define ZD_SMALL_H

#include <math.h>

#if defined(__GNUC__) || defined(__clang__)
#define ZD_INLINE static inline __attribute__((always_inline))
#else
#define ZD_INLINE static inline
#endif

/* kernel(n, ...) with n known to the compiler where it is small */
#define ZD_SIZED(kernel, n, ...)                  \
    ((n) == 3   ? kernel(3, __VA_ARGS__)          \
     : (n) == 1 ? kernel(1, __VA_ARGS__)          \
     : (n) == 2 ? kernel(2, __VA_ARGS__)          \
     : (n) == 4 ? kernel(4, __VA_ARGS__)          \
     : (n) == 5 ? kernel(5, __VA_ARGS__)          \
     : (n) == 6 ? kernel(6, __VA_ARGS__)          \
                : kernel((n), __VA_ARGS__))

ZD_INLINE double zd_dot(int n, const double *a, const double *b)
{
    double sum = 0;
    for (int i = 0; i < n; i++) sum += a[i] * b[i];
    return sum;
}

ZD_INLINE void zd_add_scaled(int n, double *y, double s, const double *x)
{
    for (int i = 0; i < n; i++) y[i] += s * x[i];
}

/* Cholesky factor L of the symmetric M = L L^T; the diagonal of L (n, n) holds reciprocals. M may be L. Returns n, or the
 * index at which M is found not positive definite to working precision. */
ZD_INLINE int zd_cholesky(const int n, const double *M, double *L)
{
    for (int j = 0; j < n; j++) {
        double diagonal = M[j * n + j], pivot = diagonal;
        for (int k = 0; k < j; k++) pivot -= L[j * n + k] * L[j * n + k];
        if (!(pivot > n * 0x1p-52 * diagonal) || !(pivot < INFINITY)) return j;
        double inverse = 1 / sqrt(pivot);
        L[j * n + j] = inverse;
        for (int i = j + 1; i < n; i++) {
            double sum = M[i * n + j];
            for (int k = 0; k < j; k++) sum -= L[i * n + k] * L[j * n + k];
            L[i * n + j] = sum * inverse;
        }
    }
    return n;
}

/* b <- L^-1 b, L with reciprocals on its diagonal and row length `stride` */
ZD_INLINE void zd_forward(const int n, const int stride, const double *L, double *b)
{
    for (int i = 0; i < n; i++) {
        double sum = b[i];
        for (int k = 0; k < i; k++) sum -= L[i * stride + k] * b[k];
        b[i] = sum * L[i * stride + i];
    }
}

/* b <- L^-T b */
ZD_INLINE void zd_backward(const int n, const int stride, const double *L, double *b)
{
    for (int i = n - 1; i >= 0; i--) {
        double sum = b[i];
        for (int k = i + 1; k < n; k++) sum -= L[k * stride + i] * b[k];
        b[i] = sum * L[i * stride + i];
    }
}

#endif
