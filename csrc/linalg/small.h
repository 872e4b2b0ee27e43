/* Small dense kernels. Each takes its size as an argument and is always inlined, so that ZD_SIZED can call it with a
 * constant: for up to six unknowns the compiler then unrolls everything, beyond that the loops are ordinary ones.
 */
#pragma once

#include <math.h>
#include <stdint.h>
#include <string.h>

#if defined(__GNUC__) || defined(__clang__)
#define ZD_INLINE static inline __attribute__((always_inline))
#elif defined(_MSC_VER)
#define ZD_INLINE static __forceinline
#else
#define ZD_INLINE static inline
#endif

/* A function that few steps call: kept out of its callers, which then save fewer registers. */
#if defined(__GNUC__) || defined(__clang__)
#define ZD_RARE static __attribute__((noinline, cold))
#else
#define ZD_RARE static
#endif

enum { ZD_UNROLLED = 6 };       /* the largest n of ZD_SIZED */

/* kernel(n, ...) with n known to the compiler where it is small */
#define ZD_SIZED(kernel, n, ...)                  \
    ((n) == 3   ? kernel(3, __VA_ARGS__)          \
     : (n) == 1 ? kernel(1, __VA_ARGS__)          \
     : (n) == 2 ? kernel(2, __VA_ARGS__)          \
     : (n) == 4 ? kernel(4, __VA_ARGS__)          \
     : (n) == 5 ? kernel(5, __VA_ARGS__)          \
     : (n) == 6 ? kernel(6, __VA_ARGS__)          \
                : kernel((n), __VA_ARGS__))

/* kernel(n, m, ...), within a kernel of n that is called so, with m known as well where it is one or two */
#define ZD_ROWS(kernel, n, m, ...)              \
    ((m) == 2   ? kernel(n, 2, __VA_ARGS__)     \
     : (m) == 1 ? kernel(n, 1, __VA_ARGS__)     \
                : kernel(n, (m), __VA_ARGS__))

ZD_INLINE void zd_copy(const int n, const double *from, double *to)
{
    for (int i = 0; i < n; i++) to[i] = from[i];
}

/* Copies of an array; and of one that is often short, in a step. */
ZD_INLINE void zd_copy_all(int n, const double *from, double *to)
{
    if (n > 0) memcpy(to, from, n * sizeof *to);        /* an empty array may be NULL */
}

ZD_INLINE void zd_copy_few(int n, const double *from, double *to)
{
    if (n > ZD_UNROLLED) zd_copy_all(n, from, to);
    else ZD_SIZED(zd_copy, n, from, to);
}

/* x <- 0 */
ZD_INLINE void zd_clear(int n, double *x)
{
    if (n > 0) memset(x, 0, n * sizeof *x);
}

/* Two neighbours in one store, or in one load. A processor hands on what it has just stored to loads of that or of a part of it; one of
 * more has to wait until it is in the cache. */
#if defined(__GNUC__) || defined(__clang__)
#define ZD_HAS_VECTORS 1
typedef double zd_two __attribute__((vector_size(16)));
typedef double zd_stored_two __attribute__((vector_size(16), aligned(8), may_alias));
typedef int64_t zd_two_masks __attribute__((vector_size(16)));

ZD_INLINE zd_two zd_two_at(const double *x) { return *(const zd_stored_two *)x; }
ZD_INLINE zd_two zd_two_of(double a, double b) { return (zd_two){a, b}; }
ZD_INLINE double zd_first_of(zd_two x) { return x[0]; }
ZD_INLINE double zd_second_of(zd_two x) { return x[1]; }
ZD_INLINE void zd_store_two(zd_two x, double *to) { *(zd_stored_two *)to = x; }
ZD_INLINE zd_two zd_minus_two(zd_two x, zd_two y) { return x - y; }
ZD_INLINE zd_two zd_plus_two(zd_two x, zd_two y) { return x + y; }
ZD_INLINE zd_two zd_times_two(zd_two x, zd_two y) { return x * y; }
#else
typedef struct zd_two { double a, b; } zd_two;

ZD_INLINE zd_two zd_two_at(const double *x) { return (zd_two){x[0], x[1]}; }
ZD_INLINE zd_two zd_two_of(double a, double b) { return (zd_two){a, b}; }
ZD_INLINE double zd_first_of(zd_two x) { return x.a; }
ZD_INLINE double zd_second_of(zd_two x) { return x.b; }
ZD_INLINE void zd_store_two(zd_two x, double *to) { to[0] = x.a, to[1] = x.b; }
ZD_INLINE zd_two zd_minus_two(zd_two x, zd_two y) { return (zd_two){x.a - y.a, x.b - y.b}; }
ZD_INLINE zd_two zd_plus_two(zd_two x, zd_two y) { return (zd_two){x.a + y.a, x.b + y.b}; }
ZD_INLINE zd_two zd_times_two(zd_two x, zd_two y) { return (zd_two){x.a * y.a, x.b * y.b}; }
#endif

ZD_INLINE zd_two zd_scaled_two(double s, zd_two x) { return zd_times_two(zd_two_of(s, s), x); }

/* a x + b y */
ZD_INLINE zd_two zd_sum_of_two(double a, zd_two x, double b, zd_two y) { return zd_plus_two(zd_scaled_two(a, x), zd_scaled_two(b, y)); }

ZD_INLINE void zd_store_pair(double a, double b, double *to) { zd_store_two(zd_two_of(a, b), to); }

/* True if a_i > b_i for all i */
ZD_INLINE int zd_all_exceed(int n, const double *a, const double *b)
{
    int i = 0, all = 1;
#ifdef ZD_HAS_VECTORS
    zd_two_masks masks = {-1, -1};
    for (; i + 1 < n; i += 2) masks &= (zd_two_masks)(*(const zd_stored_two *)(a + i) > *(const zd_stored_two *)(b + i));
    all = masks[0] && masks[1];
#endif
    for (; i < n; i++) all &= a[i] > b[i];
    return all;
}

/* to <- a - b; to may be a or b */
ZD_INLINE void zd_subtract(const int n, const double *a, const double *b, double *to)
{
    for (int i = 0; i < n; i++) to[i] = a[i] - b[i];
}

/* The same for what is loaded in pairs right after */
ZD_INLINE void zd_subtract_pairs(const int n, const double *a, const double *b, double *to)
{
    for (int i = 0; i + 1 < n; i += 2) zd_store_pair(a[i] - b[i], a[i + 1] - b[i + 1], to + i);
    if (n % 2) to[n - 1] = a[n - 1] - b[n - 1];
}

ZD_INLINE void zd_copy_pairs(const int n, const double *from, double *to)
{
    for (int i = 0; i + 1 < n; i += 2) zd_store_pair(from[i], from[i + 1], to + i);
    if (n % 2) to[n - 1] = from[n - 1];
}

ZD_INLINE double zd_dot(const int n, const double *a, const double *b)
{
    double sum = n ? a[0] * b[0] : 0;       /* 0 + x would stay an addition, as 0 + -0 is 0 */
    for (int i = 1; i < n; i++) sum += a[i] * b[i];
    return sum;
}

ZD_INLINE void zd_add_scaled(const int n, double *y, double s, const double *x)
{
    for (int i = 0; i < n; i++) y[i] += s * x[i];
}

/* The largest |x_i|; infinite if any is not a number. Without branches, which would be mispredicted. */
ZD_INLINE double zd_largest(const int n, const double *x)
{
    double largest = 0;
    int broken = 0;
    for (int i = 0; i < n; i++) {
        double size = fabs(x[i]);
        largest = size > largest ? size : largest;
        broken |= isnan(size);
    }
    return broken ? INFINITY : largest;
}

/* max |x_i| scale_i; infinite if any is not a number */
ZD_INLINE double zd_largest_scaled(const int n, const double *x, const double *scale)
{
    double largest = 0, sum = 0;            /* the sum is NaN if any entry is */
    for (int i = 0; i < n; i++) {
        double size = fabs(x[i]) * scale[i];
        largest = size > largest ? size : largest;
        sum += size;
    }
    return isnan(sum) ? INFINITY : largest;
}

/* The power of two at or below x > 0; 0 where x is too small to be scaled by one. */
ZD_INLINE double zd_power_below(double x)
{
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    bits &= UINT64_C(0x7ff) << 52;
    memcpy(&x, &bits, sizeof x);
    return x;
}

/* sums[r] <- sums[r] - a_r b for four rows a_r, `stride` apart: a sum waits for each of its terms, and four need not wait for each other */
ZD_INLINE void zd_subtract_four_dots(const int n, const double *a, const int stride, const double *b, double *sums)
{
    double s0 = sums[0], s1 = sums[1], s2 = sums[2], s3 = sums[3];
    const double *a1 = a + stride, *a2 = a1 + stride, *a3 = a2 + stride;
    for (int i = 0; i < n; i++) {
        const double x = b[i];
        s0 -= a[i] * x;
        s1 -= a1[i] * x;
        s2 -= a2[i] * x;
        s3 -= a3[i] * x;
    }
    sums[0] = s0, sums[1] = s1, sums[2] = s2, sums[3] = s3;
}

/* dots[r] <- a_r b likewise */
ZD_INLINE void zd_four_dots(const int n, const double *a, const int stride, const double *b, double *dots)
{
    const double *a1 = a + stride, *a2 = a1 + stride, *a3 = a2 + stride;
    double s0 = a[0] * b[0], s1 = a1[0] * b[0], s2 = a2[0] * b[0], s3 = a3[0] * b[0];
    for (int i = 1; i < n; i++) {
        const double x = b[i];
        s0 += a[i] * x;
        s1 += a1[i] * x;
        s2 += a2[i] * x;
        s3 += a3[i] * x;
    }
    dots[0] = s0, dots[1] = s1, dots[2] = s2, dots[3] = s3;
}

/* Row i of the factors below from column `begin` on, those before it being known; returns whether its pivot is positive. */
ZD_INLINE int zd_cholesky_row(const int n, int i, int begin, const double *M, double *L)
{
    double diagonal = M[i * n + i], pivot = diagonal;
    for (int j = begin; j < i; j++) {
        double sum = M[i * n + j];
        for (int k = 0; k < j; k++) sum -= L[i * n + k] * L[j * n + k];
        L[i * n + j] = sum;                 /* entry of L D, divided below */
    }
    for (int j = 0; j < i; j++) {
        double scaled = L[i * n + j];
        L[i * n + j] *= L[j * n + j];
        pivot -= L[i * n + j] * scaled;
    }
    if (!(pivot > n * 0x1p-52 * diagonal) || !(pivot < INFINITY)) return 0;
    L[i * n + i] = 1 / pivot;
    return 1;
}

/* Cholesky's factors without square roots, M = L D L^T, in one matrix (n, n): L below its diagonal of ones, and D, in reciprocals,
 * in place of these. A root and a division wait for each other at every pivot; here there is one division. M may be L. Returns n,
 * or the index at which M is found not positive definite to working precision. */
ZD_INLINE int zd_cholesky(const int n, const double *M, double *L)
{
    for (int i = 0, begin = 0; i < n; i++) {
        if (n > ZD_UNROLLED && i % 4 == 0) begin = i + 4 <= n ? i : 0;
        for (int j = 0; n > ZD_UNROLLED && i == begin && j < begin; j++) {    /* four rows at once: products of earlier columns */
            double sums[4];
            for (int r = 0; r < 4; r++) sums[r] = M[(i + r) * n + j];
            zd_subtract_four_dots(j, L + i * n, n, L + j * n, sums);
            for (int r = 0; r < 4; r++) L[(i + r) * n + j] = sums[r];
        }
        if (!zd_cholesky_row(n, i, begin, M, L)) return i;
    }
    return n;
}

/* L^-T D^-1 L^-1 in place of these factors, both triangles. Where a pivot is left out, its reciprocal and what is below it being zero, so
 * are its row and column. */
ZD_INLINE void zd_invert(const int n, double *L)
{
    for (int j = 0; j < n; j++)             /* L^-1 in place of L */
        for (int i = j + 1; i < n; i++) {
            double sum = -L[i * n + j];
            for (int k = j + 1; k < i; k++) sum -= L[i * n + k] * L[k * n + j];
            L[i * n + j] = sum;
        }
    for (int i = 0; i < n; i++)             /* and the product, whose row i needs those below it alone */
        for (int j = 0; j <= i; j++) {
            double sum = L[i * n + i] * (i == j ? 1 : L[i * n + j]);
            for (int k = i + 1; k < n; k++) sum += L[k * n + i] * L[k * n + k] * L[k * n + j];
            L[j * n + i] = sum;
        }
    for (int i = 0; i < n; i++)
        for (int j = 0; j < i; j++) L[i * n + j] = L[j * n + i];
}

/* x <- L^-1 b; x may be b */
ZD_INLINE void zd_forward(const int n, const double *L, const double *b, double *x)
{
    for (int i = 0; i < n; i++) {
        double sum = b[i];
        for (int k = 0; k < i; k++) sum -= L[i * n + k] * x[k];
        x[i] = sum;
    }
}

/* The same for `count` rows of B and X (count, n) */
ZD_INLINE void zd_forward_rows(const int n, int count, const double *L, const double *B, double *X)
{
    int k = 0;
    for (; n > ZD_UNROLLED && k + 4 <= count; k += 4)
        for (int i = 0; i < n; i++) {
            double sums[4];
            for (int r = 0; r < 4; r++) sums[r] = B[(k + r) * n + i];
            zd_subtract_four_dots(i, X + k * n, n, L + i * n, sums);
            for (int r = 0; r < 4; r++) X[(k + r) * n + i] = sums[r];
        }
    for (; k < count; k++) zd_forward(n, L, B + k * n, X + k * n);
}

/* x <- L^-T D^-1 b; x may be b */
ZD_INLINE void zd_backward(const int n, const double *L, const double *b, double *x)
{
    for (int i = n - 1; i >= 0; i--) {
        double sum = L[i * n + i] * b[i];
        for (int k = i + 1; k < n; k++) sum -= L[k * n + i] * x[k];
        x[i] = sum;
    }
}

/* a^T D^-1 b */
ZD_INLINE double zd_metric_dot(const int n, const double *L, const double *a, const double *b)
{
    double sum = n ? L[0] * a[0] * b[0] : 0;
    for (int i = 1; i < n; i++) sum += L[i * n + i] * a[i] * b[i];
    return sum;
}

/* Norms of vectors, for sizes, errors and tolerances. */

double zd_max_abs(int n, const double *x);      /* max |x_i|; infinite if any is NaN */
double zd_max_scaled(int n, const double *x, const double *scale);      /* max |x_i| scale_i; infinite if any is NaN */
double zd_root_mean_square(int n, const double *x, const double *scale);        /* root mean square of x_i / scale_i; 0 for n = 0 */
int zd_is_finite(int n, const double *x);       /* true if all x_i are finite */
