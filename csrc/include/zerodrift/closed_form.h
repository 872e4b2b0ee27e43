/* Functions of a system that need no leading matrix: part of system.h. */
#ifndef ZERODRIFT_CLOSED_FORM_H
#define ZERODRIFT_CLOSED_FORM_H

/* The equations with their constraints eliminated in closed form: accelerations and corrections without a leading matrix.
 *
 * An order of elimination solves the rows of C, one or a few at a time, for as many velocities: the solution of C x = rhs is x = x0 + D a,
 * with a (nv - m,) from D^T M D a = D^T (force - M x0). So there are two kinds of pivots, written if `pivots` is not NULL:
 *
 *     (solves,)       determinants of the matrices of the sets of rows
 *     (nv - m,)       relative pivots of D^T M D: positive, 1 if the elimination has not changed the diagonal entry
 *
 * Functions are pure, and return 0, or any other value if they fail; then, or if pivots are too small, the core takes the matrix path. */
typedef struct zd_elimination zd_elimination;
struct zd_elimination {
    int solves;             /* number of sets of constraints that are solved simultaneously */
    const int *solve;       /* (m,) set of the k-th of these rows and columns */
    const int *row, *column;    /* (m,) rows of C, and the velocities that they are solved for; each row once, each velocity at most once */
    /* vdot at the state, with `added` (m,) added to the right-hand side of (6), NULL: zero. pdot is written by systems with A only; lambda,
     * power and pivots may be NULL: not requested. The power is that of (28): ZD_POWER, and that of moving constraints, lambda^T Phi_t. */
    int (*accelerate)(const zd_elimination *self, const void *data, const double *inputs, const double *t, const double *p, const double *v,
                      const double *added, double *pdot, double *vdot, double *lambda, double *power, double *pivots);
    /* Phi (3), and Newton corrections in the metric of M, dp (nq,) of (25a) ... (27a) and dv (nv,) of (25b) ... (27b), both at (t, p, v), to
     * be subtracted. NULL without constraints. */
    int (*correct)(const zd_elimination *self, const void *data, const double *inputs, const double *t, const double *p, const double *v,
                   double *Phi, double *dp, double *dv);
    /* Both at once, for the end of a step: Phi, and if every |Phi| is at most `allowed` (mh,), the corrected v - dv and the results of
     * accelerate() there with `added` zero. Otherwise dp only, with unchanged v and ZD_NO_CONVERGENCE. NULL: the core calls both other
     * functions. */
    int (*finish)(const zd_elimination *self, const void *data, const double *inputs, const double *t, const double *p, double *v,
                  const double *allowed, double *Phi, double *dp, double *pdot, double *vdot, double *lambda, double *power, double *pivots);
    /* The same for formulations in independent velocities, which are those not solved for: corrections change the dependent coordinates and
     * velocities only, instead of being shortest in the metric of M; `added` as above. D (m, nv - m), written together with the pivots, NULL
     * without them: derivatives of the velocities solved for with respect to the others, in their order. */
    int (*embed)(const zd_elimination *self, const void *data, const double *inputs, const double *t, const double *p, double *v,
                 const double *added, const double *allowed, double *Phi, double *dp, double *D, double *pdot, double *vdot, double *lambda,
                 double *power, double *pivots);
    const void *program;    /* Further data of the functions, the same for all trajectories, or NULL */
};

/* Vector units: a processor that has one has all before it, too. */
enum zd_unit {
    ZD_BASELINE,            /* instructions of every processor of the architecture; products and sums are not contracted */
    ZD_AVX2,                /* AVX2 and FMA: contracted */
    ZD_AVX512               /* AVX-512 F, DQ and VL: contracted, too */
};

/* Functions for one unit and number of lanes. */
typedef struct zd_closed_form {
    enum zd_unit unit;      /* the unit that they are compiled for */
    int lanes;              /* SIMD lanes, trajectories per call, 1, 2, 4 or 8: each number of every array, of t, inputs and `data` is a
                             * group of so many; the value returned has a bit for each trajectory that failed */
    int orders;             /* at most 4: the first with sufficiently large pivots is used, which depends on the state only */
    const zd_elimination *order;    /* (orders,) */
    int embeddings;         /* at most 4, for independent velocities: the one that solves for the dependent ones is used */
    const zd_elimination *embedding;    /* (embeddings,) with embed() instead of accelerate() and finish(); for one lane only */
} zd_closed_form;

/* Piecewise cubic: for each knot its abscissa, and coefficients of powers 3, 2, 1, 0 of the distance from it, valid to the next. The last
 * knot ends it: in place of coefficients it has how the spline goes on beyond its ends (enum zd_beyond), 0, 0, and the change of the value
 * over a period. */
typedef struct zd_spline {
    int knots;              /* at least 2 */
    const double *knot;     /* (knots, 5) */
} zd_spline;

enum zd_beyond {
    ZD_BEYOND_ERROR,        /* first and last piece continue, in trial evaluations; an accepted state there is an error */
    ZD_BEYOND_CONTINUES,    /* first and last piece continue */
    ZD_BEYOND_REPEATS       /* the pieces repeat, with the change added at each period */
};

#endif
