/* Values of splines, for user functions that are tables. */
#ifndef ZERODRIFT_SPLINE_H
#define ZERODRIFT_SPLINE_H

#include <math.h>
#include <stdint.h>

#include "closed_form.h"

/* Derivative of order 0, 1 or 2 at x of the zd_spline whose address is given as a number; NaN beyond its ends, except for rounding. */
static inline double zd_spline_at(double address, double x, double order)
{
    static const double BEYOND = 1e-9;      /* part of the length: rounding beyond the ends that is accepted, as in laws/table.py */
    const zd_spline *self = (const zd_spline *)(uintptr_t)address;
    if (!self || !(order >= 0 && order <= 2)) return NAN;
    const double *knot = self->knot, *last = knot + 5 * (self->knots - 1), allowed = BEYOND * (*last - *knot);
    if (!(x >= *knot - allowed && x <= *last + allowed)) return NAN;
    int low = 0, high = self->knots - 1;
    while (high - low > 1) {
        const int middle = (low + high) / 2;
        if (knot[5 * middle] <= x) low = middle;
        else high = middle;
    }
    const double s = x - knot[5 * low], *coefficient = knot + 5 * low + 1;
    double derivative[3] = {0};
    for (int i = 0; i < 4; i++) {
        derivative[2] = derivative[2] * s + 2 * derivative[1];
        derivative[1] = derivative[1] * s + derivative[0];
        derivative[0] = derivative[0] * s + coefficient[i];
    }
    return derivative[(int)order];
}

#endif
