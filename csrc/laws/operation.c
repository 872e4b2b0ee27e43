/* Values of single operations, those of the C library included. */
#include "program.h"

#include <math.h>

#include "../include/zerodrift/sines.h"
#include "../include/zerodrift/spline.h"

#if defined(__GLIBC__) && defined(__x86_64__) && defined(__PIC__) && !defined(__PIE__)
/* In shared libraries: the functions as every glibc has them since 2012, of the same bits, so that wheels do not require a newer one. */
__asm__(".symver exp, exp@GLIBC_2.2.5\n.symver log, log@GLIBC_2.2.5\n.symver log2, log2@GLIBC_2.2.5\n"
        ".symver pow, pow@GLIBC_2.2.5\n.symver hypot, hypot@GLIBC_2.2.5\n.symver lgamma, lgamma@GLIBC_2.2.5\n.symver fmod, fmod@GLIBC_2.2.5");
#endif

static double function_value(enum zd_code code, double a, double b)
{
    switch (code) {
    case ZD_CODE_POWER: return pow(a, b);
    case ZD_CODE_ROOT: return sqrt(a);
    case ZD_CODE_SIN: return zd_sin(a);
    case ZD_CODE_COS: return zd_cos(a);
    case ZD_CODE_TAN: return tan(a);
    case ZD_CODE_ASIN: return asin(a);
    case ZD_CODE_ACOS: return acos(a);
    case ZD_CODE_ATAN: return atan(a);
    case ZD_CODE_ATAN2: return atan2(a, b);
    case ZD_CODE_SINH: return sinh(a);
    case ZD_CODE_COSH: return cosh(a);
    case ZD_CODE_TANH: return tanh(a);
    case ZD_CODE_ASINH: return asinh(a);
    case ZD_CODE_ACOSH: return acosh(a);
    case ZD_CODE_ATANH: return atanh(a);
    case ZD_CODE_EXP: return exp(a);
    case ZD_CODE_LOG: return log(a);
    case ZD_CODE_ABS: return fabs(a);
    case ZD_CODE_FLOOR: return floor(a);
    case ZD_CODE_CEILING: return ceil(a);
    case ZD_CODE_ERF: return erf(a);
    case ZD_CODE_ERFC: return erfc(a);
    case ZD_CODE_EXPM1: return expm1(a);
    case ZD_CODE_HYPOT: return hypot(a, b);
    case ZD_CODE_LOG1P: return log1p(a);
    case ZD_CODE_LOG2: return log2(a);
    case ZD_CODE_LOG10: return log10(a);
    case ZD_CODE_GAMMA: return tgamma(a);
    case ZD_CODE_LOGGAMMA: return lgamma(a);
    default: return fmod(a, b);
    }
}

double zd_operation(enum zd_code code, double a, double b, double c)
{
    switch (code) {
    case ZD_CODE_PLUS: return a + b;
    case ZD_CODE_MINUS: return a - b;
    case ZD_CODE_TIMES: return a * b;
    case ZD_CODE_OVER: return a / b;
    case ZD_CODE_NEGATIVE: return -a;
    case ZD_CODE_LESS: return a < b;
    case ZD_CODE_LESS_EQUAL: return a <= b;
    case ZD_CODE_GREATER: return a > b;
    case ZD_CODE_GREATER_EQUAL: return a >= b;
    case ZD_CODE_EQUAL: return a == b;
    case ZD_CODE_UNEQUAL: return a != b;
    case ZD_CODE_AND: return a != 0 && b != 0;
    case ZD_CODE_OR: return a != 0 || b != 0;
    case ZD_CODE_NOT: return a == 0;
    case ZD_CODE_CHOOSE: return a != 0 ? b : c;
    case ZD_CODE_SPLINE: return zd_spline_at(a, b, c);
    case ZD_CODE_TIMES_PLUS: return a * b + c;
    case ZD_CODE_TIMES_MINUS: return a * b - c;
    case ZD_CODE_MINUS_TIMES: return c - a * b;
    default: return function_value(code, a, b);
    }
}
