/* df/dy of a rate by differences, as implicit methods want it: in units in which the entries of a state compare. */
#ifndef ZD_DIFFERENCES_H
#define ZD_DIFFERENCES_H

#include "integrator.h"

typedef struct zd_differences {
    int size;
    double *scale;          /* (size,): largest terms seen in each equation: these have units of their own */
    double *unit;           /* (size,): powers of two near scale when the matrix was made, which is in these units: pivots compare */
    double *varied;         /* (size,): f at a varied y */
    double least_size;      /* of y_i, for the choice of differences: where y_i and f_i are rounding, they do not show their size */
} zd_differences;

zd_differences zd_differences_take(zd_arena *arena, int size);
/* The state has become one of another size. */
void zd_differences_resize(zd_differences *self, int size);
void zd_differences_choose_units(zd_differences *self);
/* J (size, size) <- share df/dy at (t, y), where f is known, in the units that were chosen: its entry (i, j) times unit_j / unit_i. A
 * state changes by about h f in a step. y is as it was afterwards. */
int zd_differences_make(zd_differences *self, const zd_rate *rate, double t, double h, double share, double *y, const double *f, double *J);

#endif
