/* Domain of expressions: arguments of tables must be within their ends, as far as the values depend on them. */
#include <math.h>
#include <string.h>

#include "../include/zerodrift/sines.h"
#include "../include/zerodrift/spline.h"
#include "program.h"

int zd_expressions_have_ends(const zd_expressions *self, const double *numbers)
{
    for (const zd_instruction *next = self->first; next->code != ZD_CODE_END; next++)
        if (next->code == ZD_CODE_SPLINE && zd_spline_ends_before(numbers[next->a], INFINITY, 0)) return 1;
    return 0;
}

int zd_expressions_are_within(const zd_expressions *self, const double *numbers, double t)
{
    for (const zd_instruction *next = self->first; next->code != ZD_CODE_END; next++)
        if (next->code == ZD_CODE_SPLINE && (next->b != self->numbers || zd_spline_ends_before(numbers[next->a], t, 0))) return 0;
    return 1;
}

/* The value of an instruction of one value; NaN of a spline beyond its ends. */
static double value_of(const zd_instruction *it, const double *value, double rtol, double atol)
{
    const double a = value[it->a], b = value[it->b];
    if (it->code == ZD_CODE_SPLINE && zd_spline_ends_before(a, b, atol + rtol * fabs(b))) return NAN;
    return zd_operation(it->code, a, b, value[it->c]);
}

int zd_expressions_are_defined(const zd_expressions *self, const double *numbers, double rtol, double atol, double t, const double *x,
                               const double *xdot)
{
    ZD_VALUES(double, value, self->frame);
    const size_t size = sizeof *value, terms = (size_t)self->terms, rates = (size_t)self->rates;
    double *to = value + self->numbers;
    memcpy(value, numbers, (size_t)self->numbers * size);
    *to++ = t;
    memcpy(to, x, terms * size);
    memcpy(to + terms, xdot, rates * size);
    to += terms + rates;
    for (const zd_instruction *next = self->first; next->code != ZD_CODE_END; next++) {
        const int sines = next->code == ZD_CODE_SINES ? next->b : 0;
        for (int i = 0; i < sines; i++) {
            to[i] = zd_sin(value[next[i].a]);
            to[sines + i] = zd_cos(value[next[i].a]);
        }
        if (!sines) *to = value_of(next, value, rtol, atol);
        to += sines ? 2 * sines : 1;
        next += sines ? sines - 1 : 0;
    }
    for (int i = 0; i < self->results; i++)
        if (!isfinite(value[self->result[i]])) return 0;
    return 1;
}
