/* The matrices of Newton's iteration in radau.c: J = df/dy, and gamma / h - J and (alpha - i beta) / h - J, factored. */
#ifndef ZD_RADAU_MATRICES_H
#define ZD_RADAU_MATRICES_H

#include "differences.h"

/* The eigenvalues of A^-1: Lambda = [[gamma, 0, 0], [0, alpha, beta], [0, -beta, alpha]] */
#define ZD_RADAU_GAMMA 3.6378342527444957322
#define ZD_RADAU_ALPHA 2.6810828736277521339
#define ZD_RADAU_BETA 3.0504301992474105694

typedef struct zd_radau_matrices {
    int size;
    zd_differences differences;
    double *J;              /* (size, size): df/dy in the units of the differences */
    double *real, *re, *im; /* (size, size): gamma / h - J, (alpha - i beta) / h - J in these units, factored, */
    double *weight;         /* (size,): after each row has been multiplied by this and its unit */
    int *real_order, *complex_order;
    double h;               /* that they are factored for; 0: the factors are of another J */
    int has_J;
} zd_radau_matrices;

zd_radau_matrices zd_radau_matrices_take(zd_arena *arena, int size);
void zd_radau_matrices_resize(zd_radau_matrices *self, int size);
/* J at (t, y), where f is known: the rate's own, or by differences; y is as it was afterwards. */
int zd_radau_make_J(zd_radau_matrices *self, const zd_rate *rate, double t, double h, double *y, const double *f);
/* For steps of size h; ZD_NO_STEP where a matrix is singular. */
int zd_radau_factor(zd_radau_matrices *self, double h);
/* x (size,) <- (gamma / h - J)^-1 x */
void zd_radau_solve_real(const zd_radau_matrices *self, double *x);
/* x + i y (size,) <- ((alpha - i beta) / h - J)^-1 (x + i y) */
void zd_radau_solve_complex(const zd_radau_matrices *self, double *x, double *y);

#endif
