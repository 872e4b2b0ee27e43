/* Solution of M x + C^T lambda = force, C x = rhs by elimination of bodies, for singular M or redundant constraints. */
#ifndef ZD_BODYWISE_H
#define ZD_BODYWISE_H

#include "../../point/point.h"
#include "../../point/sparse/bodies.h"

typedef struct zd_bodywise {
    const zd_layout *layout;
    zd_bodies *bodies;      /* M + C^T W C */
    double *weight;         /* (m,): W */
    double raised;          /* factor by which W was raised at this point, as iterations converged slowly */
    zd_bodies *for_least;   /* the same, weighted for multipliers of minimum effect; NULL if the multipliers are unique, or W serves */
    double *least_weight;   /* (m,) */
    int is_least_known;     /* 1: it has been factored at this point */
    double *inverse;        /* stored as M: factors of M^-1, for these weights */
    double *unbalanced, *step;  /* (n,), (n,) */
    double *residual, *lambda;  /* (m,), (m,) */
    const double *C;        /* C of the point at the factorization */
    const zd_point *point;
} zd_bodywise;

/* Allocates the symbolic structure and the factors; NULL without memory. */
zd_bodywise *zd_bodywise_create(zd_store *store, const zd_point *point);
/* Factors at the point. ZD_NOT_DEFINITE: the constraints leave a massless direction free. */
int zd_bodywise_factor(zd_bodywise *self, zd_point *point);
/* solve() of formulation.h. */
void zd_bodywise_solve(zd_bodywise *self, const double *force, const double *rhs, double *x, double *lambda);

#endif
