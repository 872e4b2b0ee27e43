/* Double-double arithmetic: a number is the unevaluated sum of two doubles, 106 bits.
 *
 *     #include <zerodrift/double_double.h>
 *     zd_double_double x = zd_dd_root(zd_dd_of(2));        x.high + x.low = 1.41421356237309504880168872420969...
 *
 * Errors are at most 2^-102 of the result for + - x / and roots, and 2^-98 of the largest of 1, argument and result for functions.
 * Products are exact sums of two doubles by `fma` where the processor has it, and by Dekker's product elsewhere; both give the same bits,
 * except where the product is below 2^-960. Doubles must be IEEE's, and the compiler must not contract a product and a sum.
 *
 * T. J. Dekker, A floating-point technique for extending the available precision, Numerische Mathematik 18 (1971) 224-242;
 * M. Joldes, J.-M. Muller, V. Popescu, Tight and rigorous error bounds for basic building blocks of double-word arithmetic, ACM Transactions
 * on Mathematical Software 44 (2017) 15.
 */
#ifndef ZERODRIFT_DOUBLE_DOUBLE_H
#define ZERODRIFT_DOUBLE_DOUBLE_H

#include <math.h>

#include "double_double_arithmetic.h"

/* 1 / n!, n from 2 */
static const zd_double_double zd_dd_inverse_factorial[] = {
    {0x1p-1, 0}, {0x1.5555555555555p-3, 0x1.5555555555555p-57}, {0x1.5555555555555p-5, 0x1.5555555555555p-59},
    {0x1.1111111111111p-7, 0x1.1111111111111p-63}, {0x1.6c16c16c16c17p-10, -0x1.f49f49f49f49fp-65},
    {0x1.a01a01a01a01ap-13, 0x1.a01a01a01a01ap-73}, {0x1.a01a01a01a01ap-16, 0x1.a01a01a01a01ap-76},
    {0x1.71de3a556c734p-19, -0x1.c154f8ddc6c00p-73}, {0x1.27e4fb7789f5cp-22, 0x1.cbbc05b4fa99ap-76},
    {0x1.ae64567f544e4p-26, -0x1.c062e06d1f209p-80}, {0x1.1eed8eff8d898p-29, -0x1.2aec959e14c06p-83},
    {0x1.6124613a86d09p-33, 0x1.f28e0cc748ebep-87}, {0x1.93974a8c07c9dp-37, 0x1.05d6f8a2efd1fp-92},
    {0x1.ae7f3e733b81fp-41, 0x1.1d8656b0ee8cbp-97}, {0x1.ae7f3e733b81fp-45, 0x1.1d8656b0ee8cbp-101},
    {0x1.952c77030ad4ap-49, 0x1.ac981465ddc6cp-103}, {0x1.6827863b97d97p-53, 0x1.eec01221a8b0bp-107},
    {0x1.2f49b46814157p-57, 0x1.2650f61dbdcb4p-112}, {0x1.e542ba4020225p-62, 0x1.ea72b4afe3c2fp-120},
};
enum { ZD_DD_FACTORIALS = 20 };     /* the last n */

/* sin and cos of k pi / 16, k from 1 to 4 */
static const zd_double_double zd_dd_sixteenths[][2] = {
    {{0x1.8f8b83c69a60bp-3, -0x1.26d19b9ff8d82p-57}, {0x1.f6297cff75cb0p-1, 0x1.562172a361fd3p-56}},
    {{0x1.87de2a6aea963p-2, -0x1.72cedd3d5a610p-57}, {0x1.d906bcf328d46p-1, 0x1.457e610231ac2p-56}},
    {{0x1.1c73b39ae68c8p-1, 0x1.b25dd267f6600p-55}, {0x1.a9b66290ea1a3p-1, 0x1.9f630e8b6dac8p-60}},
    {{0x1.6a09e667f3bcdp-1, -0x1.bdd3413b26456p-55}, {0x1.6a09e667f3bcdp-1, -0x1.bdd3413b26456p-55}},
};

/* x - k c, of a c in four parts; k is a whole number */
ZD_DD_RARE zd_double_double zd_dd_reduced(zd_double_double x, double k, const double *c)
{
    for (int i = 0; i < 4; i++) x = zd_dd_minus(x, zd_dd_two_product(k, c[i]));
    return x;
}

/* sum_i x^(2 i + first) (-1)^i / (2 i + first)!, beginning with i = 1 */
ZD_DD_INLINE zd_double_double zd_dd_alternating(zd_double_double square, int first)
{
    zd_double_double sum = zd_dd_of(0);
    for (int n = first + (ZD_DD_FACTORIALS - first) / 2 * 2; n >= 2; n -= 2)
        sum = zd_dd_times(square, zd_dd_minus(zd_dd_inverse_factorial[n - 2], sum));
    return zd_dd_negative(sum);
}

/* Sine and cosine of an angle; NaN where it is infinite, or so large that it does not tell where in the circle it is. */
ZD_DD_RARE void zd_dd_turn(zd_double_double x, zd_double_double *sine, zd_double_double *cosine)
{
    static const double quarter[] = {0x1.921fb54442d18p+0, 0x1.1a62633145c07p-54, -0x1.f1976b7ed8fbcp-110, 0x1.4cf98e804177dp-164};
    static const double sixteenth[] = {0x1.921fb54442d18p-3, 0x1.1a62633145c07p-57, -0x1.f1976b7ed8fbcp-113, 0x1.4cf98e804177dp-167};
    if (!(fabs(x.high) < 0x1p+50)) {
        *sine = *cosine = zd_dd_of(NAN);
        return;
    }
    const double turns = floor(x.high / quarter[0] + 0.5);
    zd_double_double r = zd_dd_reduced(x, turns, quarter);
    const double parts = floor(r.high / sixteenth[0] + 0.5);
    r = zd_dd_reduced(r, parts, sixteenth);
    const int quadrant = (int)(turns - 4 * floor(turns / 4)), k = (int)fabs(parts);
    const zd_double_double square = zd_dd_times(r, r);
    zd_double_double s = zd_dd_plus(r, zd_dd_times(r, zd_dd_alternating(square, 1)));
    zd_double_double c = zd_dd_plus(zd_dd_of(1), zd_dd_alternating(square, 0));
    if (k) {
        const zd_double_double u = zd_dd_scaled(zd_dd_sixteenths[k - 1][0], parts < 0 ? -1 : 1), w = zd_dd_sixteenths[k - 1][1];
        const zd_double_double turned = zd_dd_plus(zd_dd_times(s, w), zd_dd_times(c, u));
        c = zd_dd_minus(zd_dd_times(c, w), zd_dd_times(s, u));
        s = turned;
    }
    *sine = quadrant == 0 ? s : quadrant == 1 ? c : zd_dd_negative(quadrant == 2 ? s : c);
    *cosine = quadrant == 0 ? c : quadrant == 3 ? s : zd_dd_negative(quadrant == 1 ? s : c);
}

ZD_DD_RARE zd_double_double zd_dd_sin(zd_double_double x)
{
    zd_double_double sine, cosine;
    zd_dd_turn(x, &sine, &cosine);
    return sine;
}

ZD_DD_RARE zd_double_double zd_dd_cos(zd_double_double x)
{
    zd_double_double sine, cosine;
    zd_dd_turn(x, &sine, &cosine);
    return cosine;
}

ZD_DD_RARE zd_double_double zd_dd_tan(zd_double_double x)
{
    zd_double_double sine, cosine;
    zd_dd_turn(x, &sine, &cosine);
    return zd_dd_over(sine, cosine);
}

/* e^x - 1, by the series at x / 512, squared nine times */
ZD_DD_RARE zd_double_double zd_dd_expm1_of_small(zd_double_double x)
{
    const zd_double_double r = zd_dd_scaled(x, 0x1p-9);
    zd_double_double sum = zd_dd_of(0);
    for (int n = 10; n >= 2; n--) sum = zd_dd_times(r, zd_dd_plus(zd_dd_inverse_factorial[n - 2], sum));
    sum = zd_dd_plus(r, zd_dd_times(r, sum));
    for (int i = 0; i < 9; i++) sum = zd_dd_plus(zd_dd_scaled(sum, 2), zd_dd_times(sum, sum));
    return sum;
}

ZD_DD_RARE zd_double_double zd_dd_exp(zd_double_double x)
{
    static const double ln_2[] = {0x1.62e42fefa39efp-1, 0x1.abc9e3b39803fp-56, 0x1.7b57a079a1934p-111, 0};
    if (!(x.high < 709.5)) return zd_dd_of(x.high < INFINITY ? INFINITY : x.high);
    if (x.high < -740) return zd_dd_of(0);
    const double k = floor(x.high / ln_2[0] + 0.5);
    const zd_double_double value = zd_dd_plus(zd_dd_of(1), zd_dd_expm1_of_small(zd_dd_reduced(x, k, ln_2)));
    return (zd_double_double){ldexp(value.high, (int)k), ldexp(value.low, (int)k)};
}

/* One step of Newton's method from the logarithm in double precision. */
ZD_DD_RARE zd_double_double zd_dd_log(zd_double_double x)
{
    if (!(x.high > 0 && x.high < INFINITY)) return zd_dd_of(log(x.high));
    int exponent;
    const double mantissa = frexp(x.high, &exponent);
    const zd_double_double scaled = {mantissa, ldexp(x.low, -exponent)}, ln_2 = {0x1.62e42fefa39efp-1, 0x1.abc9e3b39803fp-56};
    zd_double_double y = zd_dd_of(log(mantissa));
    for (int i = 0; i < 2; i++)
        y = zd_dd_plus(y, zd_dd_minus(zd_dd_times(scaled, zd_dd_exp(zd_dd_negative(y))), zd_dd_of(1)));
    return zd_dd_plus(y, zd_dd_scaled(ln_2, exponent));
}

/* x^k of a whole number k */
ZD_DD_RARE zd_double_double zd_dd_whole_power(zd_double_double x, double k)
{
    zd_double_double power = zd_dd_of(1);
    for (double left = fabs(k); left >= 1; left = floor(left / 2), x = zd_dd_times(x, x))
        if (left - 2 * floor(left / 2) == 1) power = zd_dd_times(power, x);
    return k < 0 ? zd_dd_over(zd_dd_of(1), power) : power;
}

ZD_DD_RARE zd_double_double zd_dd_pow(zd_double_double x, zd_double_double y)
{
    if (y.low == 0 && floor(y.high) == y.high && fabs(y.high) <= 1024) return zd_dd_whole_power(x, y.high);
    if (!(x.high > 0)) return zd_dd_of(pow(x.high, y.high));
    return zd_dd_exp(zd_dd_times(y, zd_dd_log(x)));
}

/* The angle of the point (x, y): two steps of Newton's method from that in double precision. */
ZD_DD_RARE zd_double_double zd_dd_atan2(zd_double_double y, zd_double_double x)
{
    zd_double_double angle = zd_dd_of(atan2(y.high, x.high)), sine, cosine;
    const double size = fmax(fabs(x.high), fabs(y.high));
    if (!(size > 0 && size < INFINITY)) return angle;
    int exponent;
    (void)frexp(size, &exponent);
    const zd_double_double a = {ldexp(x.high, -exponent), ldexp(x.low, -exponent)}, b = {ldexp(y.high, -exponent), ldexp(y.low, -exponent)};
    const zd_double_double radius = zd_dd_root(zd_dd_plus(zd_dd_times(a, a), zd_dd_times(b, b)));
    for (int i = 0; i < 2; i++) {
        zd_dd_turn(angle, &sine, &cosine);
        angle = zd_dd_plus(angle, zd_dd_over(zd_dd_minus(zd_dd_times(b, cosine), zd_dd_times(a, sine)), radius));
    }
    return angle;
}

ZD_DD_RARE zd_double_double zd_dd_atan(zd_double_double x)
{
    return zd_dd_atan2(x, zd_dd_of(1));
}

/* (1 - x^2)^(1/2) */
ZD_DD_RARE zd_double_double zd_dd_beside(zd_double_double x)
{
    const zd_double_double one = zd_dd_of(1);
    return zd_dd_root(zd_dd_times(zd_dd_minus(one, x), zd_dd_plus(one, x)));
}

ZD_DD_RARE zd_double_double zd_dd_asin(zd_double_double x)
{
    return zd_dd_atan2(x, zd_dd_beside(x));
}

ZD_DD_RARE zd_double_double zd_dd_acos(zd_double_double x)
{
    return zd_dd_atan2(zd_dd_beside(x), x);
}

ZD_DD_RARE zd_double_double zd_dd_sinh(zd_double_double x)
{
    if (fabs(x.high) < 0.3) {       /* (d + d / (1 + d)) / 2, of d = e^x - 1 */
        const zd_double_double d = zd_dd_expm1_of_small(x);
        return zd_dd_scaled(zd_dd_plus(d, zd_dd_over(d, zd_dd_plus(zd_dd_of(1), d))), 0.5);
    }
    const zd_double_double e = zd_dd_exp(x);
    return zd_dd_scaled(zd_dd_minus(e, zd_dd_over(zd_dd_of(1), e)), 0.5);
}

ZD_DD_RARE zd_double_double zd_dd_cosh(zd_double_double x)
{
    const zd_double_double e = zd_dd_exp(x);
    return zd_dd_scaled(zd_dd_plus(e, zd_dd_over(zd_dd_of(1), e)), 0.5);
}

ZD_DD_RARE zd_double_double zd_dd_tanh(zd_double_double x)
{
    if (fabs(x.high) > 40) return zd_dd_of(x.high < 0 ? -1 : 1);
    const zd_double_double twice = zd_dd_scaled(x, 2);
    const zd_double_double d = fabs(x.high) < 0.15 ? zd_dd_expm1_of_small(twice) : zd_dd_minus(zd_dd_exp(twice), zd_dd_of(1));
    return zd_dd_over(d, zd_dd_plus(d, zd_dd_of(2)));
}

ZD_DD_RARE zd_double_double zd_dd_asinh(zd_double_double x)
{
    const zd_double_double size = zd_dd_fabs(x);
    const zd_double_double y = zd_dd_log(zd_dd_plus(size, zd_dd_root(zd_dd_plus(zd_dd_times(x, x), zd_dd_of(1)))));
    return zd_dd_is_negative(x) ? zd_dd_negative(y) : y;
}

ZD_DD_RARE zd_double_double zd_dd_acosh(zd_double_double x)
{
    const zd_double_double one = zd_dd_of(1);
    return zd_dd_log(zd_dd_plus(x, zd_dd_root(zd_dd_times(zd_dd_minus(x, one), zd_dd_plus(x, one)))));
}

ZD_DD_RARE zd_double_double zd_dd_atanh(zd_double_double x)
{
    const zd_double_double one = zd_dd_of(1);
    return zd_dd_scaled(zd_dd_log(zd_dd_over(zd_dd_plus(one, x), zd_dd_minus(one, x))), 0.5);
}

#endif
