/* Sums, products, quotients, roots and comparisons in double-double arithmetic: part of double_double.h. */
#ifndef ZERODRIFT_DOUBLE_DOUBLE_ARITHMETIC_H
#define ZERODRIFT_DOUBLE_DOUBLE_ARITHMETIC_H

#include <float.h>
#include <math.h>

#if defined(FLT_EVAL_METHOD) && FLT_EVAL_METHOD != 0
#error "double-double arithmetic must have doubles evaluated as doubles: FLT_EVAL_METHOD 0"
#endif
#if defined(__FAST_MATH__) || defined(__ASSOCIATIVE_MATH__)
#error "double-double arithmetic must not be compiled with -ffast-math"
#endif

/* ZD_DD_ON: attribute of all functions; ZD_DD_HAS_FMA: the functions are compiled for processors with fma */
#ifndef ZD_DD_ON
#define ZD_DD_ON
#endif
#if !defined(ZD_DD_HAS_FMA) && (defined(__FMA__) || defined(__ARM_FEATURE_FMA))
#define ZD_DD_HAS_FMA
#endif
#if defined(__GNUC__)
#define ZD_DD_INLINE ZD_DD_ON static inline __attribute__((always_inline, unused))
#define ZD_DD_RARE ZD_DD_ON static __attribute__((noinline, unused))
#else
#define ZD_DD_INLINE ZD_DD_ON static inline
#define ZD_DD_RARE ZD_DD_ON static inline
#endif

typedef struct zd_double_double {
    double high, low;       /* high is the sum, rounded */
} zd_double_double;

ZD_DD_INLINE zd_double_double zd_dd_of(double x)
{
    return (zd_double_double){x, 0};
}

/* a + b, exactly */
ZD_DD_INLINE zd_double_double zd_dd_two_sum(double a, double b)
{
    const double sum = a + b, of_b = sum - a, of_a = sum - of_b;
    return (zd_double_double){sum, (a - of_a) + (b - of_b)};
}

/* a + b, exactly, of |a| >= |b| */
ZD_DD_INLINE zd_double_double zd_dd_quick_sum(double a, double b)
{
    const double sum = a + b;
    return (zd_double_double){sum, b - (sum - a)};
}

#ifndef ZD_DD_HAS_FMA
/* a = high + low, both of 26 bits */
ZD_DD_INLINE zd_double_double zd_dd_split(double a)
{
    const double large = 0x1p+970, scale = fabs(a) > large ? 0x1p-60 : 1, back = fabs(a) > large ? 0x1p+60 : 1;
    const double scaled = a * scale, shifted = 134217729 * scaled, high = shifted - (shifted - scaled);
    return (zd_double_double){high * back, (scaled - high) * back};
}
#endif

/* a b, exactly unless it under- or overflows */
ZD_DD_INLINE zd_double_double zd_dd_two_product(double a, double b)
{
    const double product = a * b;
#ifdef ZD_DD_HAS_FMA
#if defined(__GNUC__)
    return (zd_double_double){product, __builtin_fma(a, b, -product)};
#else
    return (zd_double_double){product, fma(a, b, -product)};
#endif
#else
    const zd_double_double x = zd_dd_split(a), y = zd_dd_split(b);
    return (zd_double_double){product, ((x.high * y.high - product) + x.high * y.low + x.low * y.high) + x.low * y.low};
#endif
}

ZD_DD_INLINE zd_double_double zd_dd_plus(zd_double_double a, zd_double_double b)
{
    const zd_double_double high = zd_dd_two_sum(a.high, b.high), low = zd_dd_two_sum(a.low, b.low);
    const zd_double_double sum = zd_dd_quick_sum(high.high, high.low + low.high);
    return zd_dd_quick_sum(sum.high, sum.low + low.low);
}

ZD_DD_INLINE zd_double_double zd_dd_negative(zd_double_double a)
{
    return (zd_double_double){-a.high, -a.low};
}

ZD_DD_INLINE zd_double_double zd_dd_minus(zd_double_double a, zd_double_double b)
{
    return zd_dd_plus(a, zd_dd_negative(b));
}

ZD_DD_INLINE zd_double_double zd_dd_times(zd_double_double a, zd_double_double b)
{
    const zd_double_double product = zd_dd_two_product(a.high, b.high);
    return zd_dd_quick_sum(product.high, product.low + (a.high * b.low + a.low * b.high));
}

/* a b of a double b */
ZD_DD_INLINE zd_double_double zd_dd_scaled(zd_double_double a, double b)
{
    const zd_double_double product = zd_dd_two_product(a.high, b);
    return zd_dd_quick_sum(product.high, product.low + a.low * b);
}

ZD_DD_RARE zd_double_double zd_dd_over(zd_double_double a, zd_double_double b)
{
    const double first = a.high / b.high;
    zd_double_double left = zd_dd_minus(a, zd_dd_scaled(b, first));
    const double second = left.high / b.high;
    left = zd_dd_minus(left, zd_dd_scaled(b, second));
    const double third = left.high / b.high;
    const zd_double_double sum = zd_dd_quick_sum(first, second);
    return zd_dd_quick_sum(sum.high, sum.low + third);
}

ZD_DD_RARE zd_double_double zd_dd_root(zd_double_double a)
{
    if (!(a.high > 0)) return zd_dd_of(sqrt(a.high));
    const double first = sqrt(a.high);
    const double second = zd_dd_minus(a, zd_dd_two_product(first, first)).high / (2 * first);
    const zd_double_double sum = zd_dd_quick_sum(first, second);
    const double third = zd_dd_minus(a, zd_dd_times(sum, sum)).high / (2 * first);
    return zd_dd_quick_sum(sum.high, sum.low + third);
}

ZD_DD_INLINE int zd_dd_is_negative(zd_double_double a)
{
    return a.high < 0 || (a.high == 0 && a.low < 0);
}

ZD_DD_INLINE zd_double_double zd_dd_fabs(zd_double_double a)
{
    return zd_dd_is_negative(a) ? zd_dd_negative(a) : a;
}

ZD_DD_RARE zd_double_double zd_dd_floor(zd_double_double a)
{
    const double high = floor(a.high);
    return high == a.high ? zd_dd_quick_sum(high, floor(a.low)) : zd_dd_of(high);
}

ZD_DD_RARE zd_double_double zd_dd_ceil(zd_double_double a)
{
    return zd_dd_negative(zd_dd_floor(zd_dd_negative(a)));
}

#endif
