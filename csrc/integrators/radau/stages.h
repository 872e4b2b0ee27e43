/* Newton's iteration of radau.c with a Jacobian of its own for each stage: one matrix for all of them, of p alone where the state is (p,
 * v). */
#ifndef ZD_RADAU_STAGES_H
#define ZD_RADAU_STAGES_H

#include "coefficients.h"
#include "matrices.h"

typedef struct zd_radau_stages {
    double *J;              /* (stages, size, size), in the units of the matrices */
    double *factors;        /* (stages n, stages n) for n pairs, or any state of n */
    int *order;
    double *weight, *right; /* (stages n,): what its rows are multiplied by; */
    double *change;         /* (stages, size): of z */
    double B[ZD_RADAU_STAGES][ZD_RADAU_STAGES];     /* A^-1 / h */
    double BB[ZD_RADAU_STAGES][ZD_RADAU_STAGES];    /* square of B */
    double h;
} zd_radau_stages;

zd_radau_stages zd_radau_stages_create(zd_arena *arena, int size);
/* True if the state is (p, v), or small enough for one matrix of all stages. */
int zd_radau_stages_serve(const zd_radau_matrices *matrices);
/* Evaluates J at y + z (stages, size) in a step from t, and factors; stage and f (size,) are work arrays. */
int zd_radau_stages_make(zd_radau_stages *self, zd_radau_matrices *matrices, const zd_rate *rate, double t, double h, const double *y,
                         const double *z, double *stage, double *f);
/* x (stages, size) <- T^-1 dz, of (A^-1 / h - J) dz = T x. */
void zd_radau_stages_solve(const zd_radau_stages *self, const zd_radau_matrices *matrices, double *x);
/* Copies J of the last stage, at the end of the step, to the matrices. */
void zd_radau_stages_give_J(const zd_radau_stages *self, zd_radau_matrices *matrices);

#endif
