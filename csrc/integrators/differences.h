/* df/dy of a rate by finite differences, for implicit methods, in units that make the entries of a state comparable: for the trapezoidal
 * rule; and for Radau's method where motion/jacobian.c has no derivatives of the rate, which are Baumgarte's terms and the corrections' own
 * entries of the state, states at a bifurcation, and in independent velocities the system's own complement D and large structures. */
#ifndef ZD_DIFFERENCES_H
#define ZD_DIFFERENCES_H

#include "integrator.h"

typedef struct zd_differences {
    int size;
    double *scale;          /* (size,): largest terms so far in each equation, which has a unit of its own */
    double *unit;           /* (size,): unit of each entry of the matrix, a power of two near its scale when the matrix was made */
    double *varied;         /* (size,): f at a varied y; or increments */
    double min_size;      /* smallest size of y_i assumed for increments: y_i and f_i may be rounding errors only */
} zd_differences;

zd_differences zd_differences_create(zd_arena *arena, int size);
/* Adapts to a state of another size. */
void zd_differences_resize(zd_differences *self, int size);
void zd_differences_choose_units(zd_differences *self);
/* increment (size,) of each entry for a difference along it, of which y + increment - y is exact. */
void zd_differences_increments(const zd_differences *self, const double *y, double *increment);
/* J (size, size) <- share df/dy at (t, y), where f is known, in the units that were chosen: its entry (i, j) times unit_j / unit_i. A
 * state changes by about h f in a step. y is as it was afterwards. */
int zd_differences_make(zd_differences *self, const zd_rate *rate, double t, double h, double share, double *y, const double *f, double *J);

#endif
