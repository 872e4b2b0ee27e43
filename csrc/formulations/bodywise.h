/* M x + C^T lambda = force, C x = rhs by elimination of bodies, where M is singular or rows of C follow from others. */
#ifndef ZD_BODYWISE_H
#define ZD_BODYWISE_H

#include "../point/bodies.h"
#include "../point/point.h"

typedef struct zd_bodywise {
    const zd_layout *layout;
    zd_bodies *bodies;      /* M + C^T W C */
    double *weight;         /* (m,): W */
    zd_bodies *for_least;   /* the same with other weights, for multipliers of least effect; NULL where these are determined, or W serves */
    double *least_weight;   /* (m,) */
    int is_least_known;     /* whether it has been factored where the others were */
    double *inverse;        /* stored as M is: M^-1 by its factors, for these weights */
    double *unbalanced, *step;  /* (n,), (n,) */
    double *rest, *lambda;  /* (m,), (m,) */
    const double *C;        /* of the point where it was factored */
    const zd_point *point;
} zd_bodywise;

/* All that is symbolic, and memory for the factors; NULL where there is none. */
zd_bodywise *zd_bodywise_create(zd_store *store, const zd_point *point);
/* ZD_NOT_DEFINITE: what has no mass is not held. */
int zd_bodywise_factor(zd_bodywise *self, zd_point *point);
/* As the solve of formulation.h. */
void zd_bodywise_solve(zd_bodywise *self, const double *force, const double *rhs, double *x, double *lambda);

#endif
