/* Sines and cosines to one unit in the last place, with the same bits on every machine.
 *
 *     #include <zerodrift/sines.h>
 *     double s[3], c[3];
 *     zd_sines(3, p, s, c);           s[i] <- sin p[i], c[i] <- cos p[i]
 *
 * Angles stand side by side, and nothing branches up to 2^19, so that a compiler can take several in one vector; what an angle
 * gives does not depend on those beside it. Angles of any size are reduced exactly: up to 2^19 by subtracting multiples of pi/2 in
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

#include <math.h>
#include <stdint.h>
#include <string.h>

#if defined(__GNUC__) || defined(__clang__)
#define ZD_SINES_INLINE static inline __attribute__((always_inline))
#define ZD_SINES_RARE static __attribute__((noinline, cold, unused))
#else
#define ZD_SINES_INLINE static inline
#define ZD_SINES_RARE static inline
#endif

/* An angle is quadrant pi/2 + r + tail, where |r| is at most pi/4 and a little, and the tail is below the last place of r. */
typedef struct zd_reduced {
    double r, tail;
    uint64_t quadrant;      /* the last two bits count */
} zd_reduced;

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

/* Sine and cosine by Remez' polynomials in z = r^2, which are 2^-58 and 2^-64 off. What is rounded last is r or 1 - z/2 and something
 * that is small beside it. The sine is written as a difference, as -0 - 0 is -0, but -0 + 0 is not. */
ZD_SINES_INLINE void zd_sines_of_reduced(zd_reduced a, double *s, double *c)
{
    double r = a.r, z = r * r, z2 = z * z, z4 = z2 * z2, half = 0.5 * z, w = 1 - half;
    double S = ((-0x1.5555555555549p-3 + z * 0x1.111111110f87ap-7) + z2 * (-0x1.a01a019c11978p-13 + z * 0x1.71de3577b56b1p-19))
               + z4 * (-0x1.ae5e6639d428fp-26 + z * 0x1.5d9300cf18812p-33);
    double C = ((0x1.555555555554cp-5 + z * -0x1.6c16c16c1517ep-10) + z2 * (0x1.a01a019cb1bebp-16 + z * -0x1.27e4f809f15ecp-22))
               + z4 * (0x1.1ee9ebe9aae80p-29 + z * -0x1.8fae9cb4449ffp-37);
    double sine = r - ((half * a.tail - a.tail) - (r * z) * S);
    double cosine = w + (((1 - w) - half) + (z2 * C - r * a.tail));
    uint64_t odd = 0 - (a.quadrant & 1), u = zd_bits_of(sine), v = zd_bits_of(cosine);
    *s = zd_double_of(((u & ~odd) | (v & odd)) ^ (a.quadrant & 2) << 62);
    *c = zd_double_of(((v & ~odd) | (u & odd)) ^ ((a.quadrant + 1) & 2) << 62);
}

/* Of |x| up to 2^19: products with the first three parts of pi/2, of 33 bits each, are exact, and so are the errors of differences. */
ZD_SINES_INLINE zd_reduced zd_reduce_near(double x)
{
    double shifted = x * 0x1.45f306dc9c883p-1 + 0x1.8p52, k = shifted - 0x1.8p52;      /* k, next to x 2/pi, is in its last bits */
    double first = x - k * 0x1.921fb544p+0;
    double b = k * 0x1.0b4611a6p-34, second = first - b;
    double c = k * 0x1.3198a2ep-69, r = second - c;
    double tail = (((first - second) - b) + ((second - r) - c)) - k * 0x1.b839a252049c1p-104;
    return (zd_reduced){r, tail, zd_bits_of(shifted)};
}

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

/* Of any finite |x| from 2^19 on. None is nearer to a multiple of pi/2 than 2^-62, so that at least 70 bits behind the zeros are right. */
ZD_SINES_RARE zd_reduced zd_reduce_far(double x)
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
    return (zd_reduced){scale * r, scale * tail, x < 0 ? 0 - quadrant : quadrant};
}

/* Angles of which one at least is no number or not within +-2^19 */
ZD_SINES_RARE void zd_sines_far(int n, const double *angle, double *s, double *c)
{
    for (int i = 0; i < n; i++) {
        double x = angle[i], size = fabs(x);
        if (size < INFINITY)
            zd_sines_of_reduced(size <= 0x1p19 ? zd_reduce_near(x) : zd_reduce_far(x), s + i, c + i);
        else
            s[i] = c[i] = x - x;
    }
}

/* s, c (n,) <- sines and cosines of `angle` (n,), which is neither of them */
ZD_SINES_INLINE void zd_sines(const int n, const double *restrict angle, double *restrict s, double *restrict c)
{
#if defined(__FAST_MATH__) || defined(__ASSOCIATIVE_MATH__)
    for (int i = 0; i < n; i++) s[i] = sin(angle[i]), c[i] = cos(angle[i]);
#else
    int far = 0;
    for (int i = 0; i < n; i++) far |= !(fabs(angle[i]) <= 0x1p19);
    for (int i = 0; i < n; i++) zd_sines_of_reduced(zd_reduce_near(angle[i]), s + i, c + i);
    if (far) zd_sines_far(n, angle, s, c);
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
