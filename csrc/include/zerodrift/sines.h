/* Sines and cosines to one unit in the last place, with the same bits on every machine.
 *
 *     #include <zerodrift/sines.h>
 *     double s[3], c[3];
 *     zd_sines(3, p, s, c);           s[i] <- sin p[i], c[i] <- cos p[i]
 *
 * Angles stand side by side, and nothing branches up to 2^19, so that several go in one vector; what an angle gives does not
 * depend on those beside it. Angles of any size are reduced exactly: up to 2^19 by subtracting multiples of pi/2 in
 * parts (W. J. Cody, W. Waite, Software Manual for the Elementary Functions, 1980), beyond by multiplying with as many digits of
 * 2/pi as that takes (M. Payne, R. Hanek, Radian reduction for trigonometric functions, SIGNUM Newsletter 18, 1983). The sine of -0
 * is -0, and those of infinities are NaN.
 *
 * The bits are the same wherever doubles are IEEE's, rounding is to nearest, and the compiler neither reorders sums nor contracts a
 * product and a sum to one operation: -ffp-contract=off. With contraction they are as accurate. With -ffast-math they would be
 * wrong, and the C library's take their place.
 */
#ifndef ZERODRIFT_SINES_H
#define ZERODRIFT_SINES_H

#include <stdint.h>
#include <string.h>

#if defined(__GNUC__) || defined(__clang__)
#define ZD_SINES_INLINE static inline __attribute__((always_inline))
#define ZD_SINES_RARE static __attribute__((noinline, cold, unused))
#define ZD_SIZE_OF(x) __builtin_fabs(x)     /* <math.h> takes a compiler longer than all that is below */
#else
#include <math.h>
#define ZD_SINES_INLINE static inline
#define ZD_SINES_RARE static inline
#define ZD_SIZE_OF(x) fabs(x)
#endif
#if defined(__FAST_MATH__) || defined(__ASSOCIATIVE_MATH__)
#include <math.h>
#endif

ZD_SINES_INLINE uint64_t zd_bits_of(double x)
{
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}

ZD_SINES_INLINE double zd_double_of(uint64_t bits)
{
    double x;
    memcpy(&x, &bits, sizeof x);
    return x;
}

#define ZD_SINES_LARGE 0x1p19    /* the largest angle that is reduced without branches */

#define ZD_OF_TYPE(name) name
#define ZD_REAL double
#define ZD_WORDS uint64_t
#define ZD_INLINED ZD_SINES_INLINE
#define ZD_WORDS_OF zd_bits_of
#define ZD_REAL_OF zd_double_of
#define ZD_TIMES_PLUS(a, b, c) ((a) * (b) + (c))
#define ZD_LESS_TIMES(c, a, b) ((c) - (a) * (b))
#include "sines_kernel.h"
#undef ZD_OF_TYPE
#undef ZD_REAL
#undef ZD_WORDS
#undef ZD_WORDS_OF
#undef ZD_REAL_OF

#if defined(__GNUC__) || defined(__clang__)
#define ZD_SINES_IN_PAIRS 1
typedef double zd_pair __attribute__((vector_size(16)));
typedef uint64_t zd_pair_of_words __attribute__((vector_size(16)));
#define ZD_OF_TYPE(name) name##_of_pair
#define ZD_REAL zd_pair
#define ZD_WORDS zd_pair_of_words
#define ZD_WORDS_OF(x) ((zd_pair_of_words)(x))
#define ZD_REAL_OF(w) ((zd_pair)(w))
#include "sines_kernel.h"
#undef ZD_OF_TYPE
#undef ZD_REAL
#undef ZD_WORDS
#undef ZD_WORDS_OF
#undef ZD_REAL_OF
#endif
#undef ZD_INLINED
#undef ZD_TIMES_PLUS
#undef ZD_LESS_TIMES

/* ---- the rare case: an angle is not within +-2^19, or NaN ---- */

#ifdef ZD_LARGE_SINES_OF_CORE

/* Compilers take as long for it as for a quarter of a small system. So a library that is compiled when it is wanted receives the
 * functions of the core, zd_sines_of_large and zd_reductions_of_large, before it is called. */
static void (*zd_large_sines)(int n, const double *angle, double *s, double *c);
static void (*zd_reduce_large_ones)(int n, const double *angle, double *r, double *tail, uint64_t *quadrant);

void zd_set_sines_of_large(void (*sines)(int, const double *, double *, double *),
                           void (*reductions)(int, const double *, double *, double *, uint64_t *));
void zd_set_sines_of_large(void (*sines)(int, const double *, double *, double *),
                           void (*reductions)(int, const double *, double *, double *, uint64_t *))
{
    zd_large_sines = sines;
    zd_reduce_large_ones = reductions;
}

#else

/* 32 bits of a number that is written in words, from one bit on */
ZD_SINES_INLINE uint32_t zd_word_at(const uint32_t *words, int bit)
{
    const uint32_t *w = words + bit / 32;
    return (uint32_t)(((uint64_t)w[0] << 32 | w[1]) << bit % 32 >> 32);
}

/* product <- x 2/pi modulo 4, in 192 bits of which the first two are before the point; |x| is at least 2^19 */
ZD_SINES_INLINE void zd_multiply_by_two_over_pi(double x, uint32_t *product)
{
    static const uint32_t two_over_pi[] = {     /* behind 64 bits of zero, after the point */
        0,          0,          0xa2f9836e, 0x4e441529, 0xfc2757d1, 0xf534ddc0, 0xdb629599, 0x3c439041, 0xfe5163ab, 0xdebbc561,
        0xb7246e3a, 0x424dd2e0, 0x06492eea, 0x09d1921c, 0xfe1deb1c, 0xb129a73e, 0xe88235f5, 0x2ebb4484, 0xe99c7026, 0xb45f7e41,
        0x3991d639, 0x835339f4, 0x9c845f8b, 0xbdf9283b, 0x1ff897ff, 0xde05980f, 0xef2f118b, 0x5a0a6d1f, 0x6d367ecf, 0x27cb09b7,
        0x4f463f66, 0x9e5fea2d, 0x7527bac7, 0xebe5f17b, 0x3d0739f7, 0x8a5292ea, 0x6bfb5fb1, 0x1f8d5d08, 0x56033046, 0xfc7b6bab};
    uint64_t bits = zd_bits_of(x), digits = (bits & 0xfffffffffffff) | UINT64_C(1) << 52, low = 0, high = 0;
    int first = (int)(bits >> 52 & 0x7ff) - 1075 - 2 + 64;      /* x is digits 2^exponent: what is before are multiples of 4 */
    for (int i = 5; i >= 0; i--) {
        uint32_t word = zd_word_at(two_over_pi, first + 32 * i);
        low += word * (digits & 0xffffffff);
        uint64_t sum = (low & 0xffffffff) + (high & 0xffffffff);
        product[i] = (uint32_t)sum;
        high = (high >> 32) + word * (digits >> 32) + (sum >> 32);
        low >>= 32;
    }
}

/* Reduction of any finite |x| >= 2^19. None is closer to a multiple of pi/2 than 2^-62: at least 70 bits after the zeros are right. */
ZD_SINES_RARE void zd_reduce_large(double x, zd_reduced *reduced)
{
    uint32_t y[7] = {0};
    zd_multiply_by_two_over_pi(x, y);
    uint64_t quadrant = (y[0] + 0x20000000u) >> 30;
    int below = (int)(y[0] >> 29 & 1), zeros = 2;
    for (int i = 0; below && i < 6; i++) y[i] = ~y[i];      /* to the next multiple: less by one in the last bit */
    y[0] &= 0x3fffffff;
    while (!(zd_word_at(y, zeros) >> 31)) zeros++;
    double a = zd_word_at(y, zeros) >> 6, b = 0x1p-32 * zd_word_at(y, zeros + 26) + 0x1p-64 * zd_word_at(y, zeros + 58);
    double product = a * 0x1.921fb5p+0, rest = a * 0x1.110b4611a6263p-26 + b * 0x1.921fb54442d18p+0;
    double r = product + rest, tail = (product - r) + rest, scale = zd_double_of((uint64_t)(1023 - 24 - zeros) << 52);
    if (below != (x < 0)) scale = -scale;
    *reduced = (zd_reduced){scale * r, scale * tail, x < 0 ? 0 - quadrant : quadrant};
}

/* Reduction of any number; NaN for infinities and NaN. */
ZD_SINES_RARE void zd_reduce(double x, zd_reduced *reduced)
{
    if (ZD_SIZE_OF(x) <= ZD_SINES_LARGE)
        zd_reduce_moderate(x, reduced);
    else if (ZD_SIZE_OF(x) <= 0x1.fffffffffffffp1023)
        zd_reduce_large(x, reduced);
    else
        *reduced = (zd_reduced){x - x, 0, 0};
}

ZD_SINES_RARE void zd_large_sines(int n, const double *angle, double *s, double *c)
{
    for (int i = 0; i < n; i++) {
        zd_reduced reduced;
        zd_reduce(angle[i], &reduced);
        zd_sines_of_reduced(&reduced, s + i, c + i);
    }
}

/* r, tail, quadrant (n,) of large angles; those of others are unchanged */
ZD_SINES_RARE void zd_reduce_large_ones(int n, const double *angle, double *r, double *tail, uint64_t *quadrant)
{
    for (int i = 0; i < n; i++) {
        if (ZD_SIZE_OF(angle[i]) <= ZD_SINES_LARGE) continue;
        zd_reduced reduced;
        zd_reduce(angle[i], &reduced);
        r[i] = reduced.r, tail[i] = reduced.tail, quadrant[i] = reduced.quadrant;
    }
}

#endif

#ifdef ZD_SINES_IN_PAIRS
/* Sines and cosines of two angles. The rare case has its own variables, so that the others can stay in registers. */
ZD_SINES_INLINE void zd_sines_of_two(const zd_pair angle, zd_pair *s, zd_pair *c)
{
    zd_reduced_of_pair a;
    zd_reduce_moderate_of_pair(angle, &a);
    zd_sines_of_reduced_of_pair(&a, s, c);
    const zd_pair size = (zd_pair)((zd_pair_of_words)angle & ~(UINT64_C(1) << 63));
    const zd_pair_of_words is_large = ~(zd_pair_of_words)(size <= ZD_SINES_LARGE);
    if (is_large[0] | is_large[1]) {
        const double given[] = {angle[0], angle[1]};
        double sine[2], cosine[2];
        zd_large_sines(2, given, sine, cosine);
        *s = (zd_pair){sine[0], sine[1]};
        *c = (zd_pair){cosine[0], cosine[1]};
    }
}
#endif

/* s, c (n,) <- sines and cosines of `angle` (n,), which is neither of them. Compilers that have vectors take two at once, the last beside
 * a zero: left to themselves, they put together and take apart more than they save. */
ZD_SINES_INLINE void zd_sines(const int n, const double *restrict angle, double *restrict s, double *restrict c)
{
#if defined(__FAST_MATH__) || defined(__ASSOCIATIVE_MATH__)
    for (int i = 0; i < n; i++) s[i] = sin(angle[i]), c[i] = cos(angle[i]);
#elif defined(ZD_SINES_IN_PAIRS)
    for (int i = 0; i < n; i += 2) {
        zd_pair sine, cosine;
        zd_sines_of_two((zd_pair){angle[i], i + 1 < n ? angle[i + 1] : 0}, &sine, &cosine);
        s[i] = sine[0], c[i] = cosine[0];
        if (i + 1 < n) s[i + 1] = sine[1], c[i + 1] = cosine[1];
    }
#else
    int is_large = 0;
    for (int i = 0; i < n; i++) is_large |= !(ZD_SIZE_OF(angle[i]) <= ZD_SINES_LARGE);
    for (int i = 0; i < n; i++) {
        zd_reduced reduced;
        zd_reduce_moderate(angle[i], &reduced);
        zd_sines_of_reduced(&reduced, s + i, c + i);
    }
    if (is_large) zd_large_sines(n, angle, s, c);
#endif
}

ZD_SINES_INLINE double zd_sin(double angle)
{
    double s, c;
    zd_sines(1, &angle, &s, &c);
    return s;
}

ZD_SINES_INLINE double zd_cos(double angle)
{
    double s, c;
    zd_sines(1, &angle, &s, &c);
    return c;
}

#endif
