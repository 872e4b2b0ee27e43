/* Newton's iteration of Radau's method: its numbers, matrices, factors and stages. */
#pragma once

#include "../../linalg/small.h"
#include "../integrator.h"

/* The numbers of Radau's method IIA with three stages: Hairer and Wanner, section IV.8. */

enum { ZD_RADAU_STAGES = 3 };

/* The eigenvalues of A^-1: Lambda = [[gamma, 0, 0], [0, alpha, beta], [0, -beta, alpha]] */
#define ZD_RADAU_GAMMA 3.6378342527444957322
#define ZD_RADAU_ALPHA 2.6810828736277521339
#define ZD_RADAU_BETA 3.0504301992474105694

static const double zd_radau_c[ZD_RADAU_STAGES] = {0.15505102572168219018, 0.64494897427831780982, 1};

/* A^-1 = T Lambda T^-1 */
static const double zd_radau_T[ZD_RADAU_STAGES][ZD_RADAU_STAGES] = {
    {0.0944387624889752415, -0.141255295020954208, 0.0300291941051474245},
    {0.250213122965333311, 0.204129352293799932, -0.382942112757261938},
    {1, 1, 0},
};
static const double zd_radau_T_inverse[ZD_RADAU_STAGES][ZD_RADAU_STAGES] = {
    {4.17871859155190473, 0.327682820761062387, 0.523376445499449548},
    {-4.17871859155190473, -0.327682820761062387, 0.476623554500550452},
    {0.502872634945786876, -2.57192694985560543, 0.596039204828224925},
};

/* to (stages, n) <- matrix (stages, stages) times from */
ZD_INLINE void zd_radau_transform(const int n, const double matrix[ZD_RADAU_STAGES][ZD_RADAU_STAGES], const double *restrict from,
                                  double *restrict to)
{
    for (int s = 0; s < ZD_RADAU_STAGES; s++)
        for (int i = 0; i < n; i++) to[s * n + i] = matrix[s][0] * from[i] + matrix[s][1] * from[n + i] + matrix[s][2] * from[2 * n + i];
}

/* The value at a share of the step of the polynomial through 0 and the three stages z */
ZD_INLINE double zd_radau_dense_output(const double *z, int n, double x)
{
    double sum = 0;
    for (int i = 0; i < ZD_RADAU_STAGES; i++) {
        double basis = x / zd_radau_c[i];
        for (int j = 0; j < ZD_RADAU_STAGES; j++)
            if (j != i) basis *= (x - zd_radau_c[j]) / (zd_radau_c[i] - zd_radau_c[j]);
        sum += basis * z[i * n];
    }
    return sum;
}

/* Matrices of Newton's iteration in radau.c: J = df/dy, and the factors of gamma / h - J and (alpha - i beta) / h - J. */

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

/* The factors of Newton's iteration in radau.c, of matrices as large as the state or, as pairs.c has them, half of that. */

/* For steps of size h; ZD_NO_STEP where a matrix is singular. */
int zd_radau_factor_real(zd_radau_matrices *self, double h);
int zd_radau_factor(zd_radau_matrices *self, double h);
/* x (size,) <- (gamma / h - J)^-1 x */
void zd_radau_solve_real(const zd_radau_matrices *self, double *x);
/* x + i y (size,) <- ((alpha - i beta) / h - J)^-1 (x + i y) */
void zd_radau_solve_complex(const zd_radau_matrices *self, double *x, double *y);

/* Newton's matrices of Radau's method, where a state (p, v) lets them have half its size. */

/* 0 where the matrix is singular. */
int zd_radau_pairs_factor_real(zd_radau_matrices *self, double h);
int zd_radau_pairs_factor_complex(zd_radau_matrices *self, double h);
/* As zd_radau_solve_real and zd_radau_solve_complex */
void zd_radau_pairs_solve_real(const zd_radau_matrices *self, double *x);
void zd_radau_pairs_solve_complex(const zd_radau_matrices *self, double *x, double *y);

/* Newton's iteration of radau.c with a Jacobian of its own for each stage: one matrix for all of them, of p alone where the state is (p,
 * v). */

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

/* Newton's iteration for the stages of a step of radau.c, with its tests of convergence. */

typedef struct zd_radau_newton {
    int size;               /* entries of the state */
    const zd_rate *rate;
    const double *y0;       /* (size,): state at the start of the step */
    double t0, h;           /* s: time there, NaN before the first, and size of the step */
    double *z, *w;          /* (stages, size): stages minus y0; T^-1 z */
    double *f;              /* (stages, size): rates at the stages */
    double *change;         /* (stages, size): change of w by an iteration */
    double *other;          /* (stages, size): the same for stages disturbed in their last bit */
    double *stage;          /* (size,): one stage */
    double *scale;          /* (size,): error scale of the step */
    int has_scale;          /* true if `scale` is set; otherwise the step is solved to rounding */
    zd_radau_matrices matrices;
    zd_radau_stages stages;
    int by_stages;          /* true if each stage has its own J */
    double *seen;           /* (size,): largest size of each entry so far; scale of the differences */
    double contraction;     /* largest ratio of a change to the one before, of this iteration or an earlier one */
    double norm_before;     /* norm of the previous change in this step; 0: none */
    int iterations;
} zd_radau_newton;

zd_radau_newton zd_radau_newton_create(zd_arena *arena, const zd_rate *rate, const double *y, int size);
/* Solves for z, from its estimate, with matrices factored for this step. ZD_NO_CONVERGENCE, ZD_NOT_FINITE, or the status of the rate */
int zd_radau_newton_iterate(zd_radau_newton *self, zd_statistics *statistics);
