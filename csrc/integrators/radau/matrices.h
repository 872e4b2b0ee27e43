/* Matrices of Newton's iteration in radau.c: J = df/dy, and the factors of gamma / h - J and (alpha - i beta) / h - J. */
#ifndef ZD_RADAU_MATRICES_H
#define ZD_RADAU_MATRICES_H

#include "../differences.h"
#include "coefficients.h"

typedef struct zd_radau_matrices {
    int size, pairs;        /* copies of the rate's */
    zd_differences differences;
    double *inverse_unit;   /* (size,): inverse of differences.unit */
    double *inverse_slope;  /* (pairs,): dv/d(pdot) in these units */
    double *J;              /* (size, size): df/dy in the units of the differences */
    double *real, *re, *im; /* gamma / h - J, (alpha - i beta) / h - J in these units, factored: (size, size), or as pairs.c has it, */
    double *weight;         /* (size,): factor by which each row is multiplied before factoring, besides its unit */
    int *real_order, *complex_order;
    double *scaled, *right; /* (size,): working space */
    double h, complex_h;    /* step sizes for which the real and the complex matrix are factored; 0: factors of another J */
    int has_J;
} zd_radau_matrices;

zd_radau_matrices zd_radau_matrices_create(zd_arena *arena, int size);
void zd_radau_matrices_resize(zd_radau_matrices *self, int size, int pairs);
/* J at (t, y): the rate's own, or by differences, where f is known or, with knows_f 0, evaluated; y is as it was afterwards. In the units
 * that were chosen last. */
int zd_radau_evaluate_J(zd_radau_matrices *self, const zd_rate *rate, double t, double h, double *y, double *f, int knows_f, double *J);
/* The same for self->J, in units that are chosen for it. */
int zd_radau_make_J(zd_radau_matrices *self, const zd_rate *rate, double t, double h, double *y, double *f);

#endif
