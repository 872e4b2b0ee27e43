#include "roots.h"

double zd_power(double y, int k)
{
    double product = 1;
    for (int i = 0; i < k; i++) product *= y;
    return product;
}

/* Halley's iteration for y^k = x, which triples its digits each time. It begins from the exponent of x shared out evenly, and from a line
 * through the values at both ends of what is left: within a sixteenth of the root. */
double zd_root(double x, int k)
{
    if (!(x > 0 && x < INFINITY)) return x;
    int exponent;
    double mantissa = 2 * frexp(x, &exponent);              /* from 1 to 2 */
    exponent--;
    int whole = exponent / k - (exponent % k < 0), rest = exponent - k * whole;     /* x = mantissa 2^rest (2^whole)^k */
    double reduced = ldexp(mantissa, rest), y = 1 + (rest + mantissa - 1) / k;
    for (int i = 0; i < (k > 16 ? 8 : 3); i++) {
        double now = zd_power(y, k);
        y *= ((k - 1) * now + (k + 1) * reduced) / ((k + 1) * now + (k - 1) * reduced);
    }
    return ldexp(y, whole);
}
