#include "roots.h"

#include <stdint.h>
#include <string.h>

double zd_power(double y, int k)
{
    double product = 1;
    for (int i = 0; i < k; i++) product *= y;
    return product;
}

/* x 2^n, as ldexp() has it; without a call where 2^n and the product are normal numbers, for x from 1 to 2. */
static double scaled(double x, int n)
{
    if (n < -1000 || n > 1000) return ldexp(x, n);
    const uint64_t bits = (uint64_t)(1023 + n) << 52;
    double power;
    memcpy(&power, &bits, sizeof power);
    return x * power;
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
    double reduced = scaled(mantissa, rest), y = 1 + (rest + mantissa - 1) / k;
    for (int i = 0; i < (k > 16 ? 8 : 3); i++) {
        double now = zd_power(y, k);
        y *= ((k - 1) * now + (k + 1) * reduced) / ((k + 1) * now + (k - 1) * reduced);
    }
    return scaled(y, whole);
}
