/* Values of splines, for user functions that are tables. */
#ifndef ZERODRIFT_SPLINE_H
#define ZERODRIFT_SPLINE_H

#include <math.h>
#include <stdint.h>

#include "closed_form.h"

/* Derivative of order 0, 1 or 2 at x of the zd_spline whose address is given as a number. */
static inline double zd_spline_at(double address, double x, double order)
{
    const zd_spline *self = (const zd_spline *)(uintptr_t)address;
    if (!self || !(order >= 0 && order <= 2)) return NAN;
    const double *knot = self->knot, *last = knot + 5 * (self->knots - 1);
    const double periods = last[1] == (double)ZD_BEYOND_REPEATS ? floor((x - *knot) / (*last - *knot)) : 0;
    x -= periods * (*last - *knot);
    const double place = (x - *knot) / (*last - *knot) * (self->knots - 1);     /* index, if knots are equally far apart */
    int low = 0, high = self->knots - 1;
    if (place >= 0 && place < high) {
        const double *guess = knot + 5 * (int)place;
        if (guess[0] <= x && x < guess[5]) low = (int)place, high = low + 1;
    }
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
    derivative[0] += periods * last[4];
    return derivative[(int)order];
}

/* True if the argument x of this spline is beyond its ends by more than `allowed` and rounding, and that is an error. */
static inline int zd_spline_ends_before(double address, double x, double allowed)
{
    static const double ROUNDING = 1e-9;    /* part of the length, as in laws/table.py */
    const zd_spline *self = (const zd_spline *)(uintptr_t)address;
    if (!self) return 0;
    const double *first = self->knot, *last = first + 5 * (self->knots - 1);
    return last[1] == (double)ZD_BEYOND_ERROR && fmax(*first - x, x - *last) > fmax(allowed, ROUNDING * (*last - *first));
}

#endif
