/* Roots that have the same bits wherever doubles are those of IEEE 754: libraries of mathematics differ in their last digits, and hypot
 * ties a program to the newest C libraries. */
#pragma once

#include <math.h>

double zd_power(double x, int k);       /* x^k */
double zd_root(double x, int k);        /* x^(1/k) of an x that is not negative; to rounding for k from 1 to 16, to some digits for more */

/* (x^2 + y^2)^(1/2), without overflow between. In the header, as systems are compiled by themselves, too. */
static inline double zd_hypotenuse(double x, double y)
{
    double largest = fmax(fabs(x), fabs(y));
    if (!(largest > 0 && largest < INFINITY)) return largest;       /* zero, infinite, or not a number */
    int exponent = 0;
    if (largest < 0x1p-500 || largest > 0x1p+500) (void)frexp(largest, &exponent);
    x = ldexp(x, -exponent);
    y = ldexp(y, -exponent);
    return ldexp(sqrt(x * x + y * y), exponent);
}
