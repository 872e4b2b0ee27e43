/* Entry of the table of formulations: a leading matrix and its solve, and the state that is integrated. */
#pragma once

#include "../constraints/rank.h"

enum zd_many {
    ZD_FEW_ROWS_ONLY,
    ZD_MANY_CONSTRAINTS,
    ZD_MANY_CONSTRAINTS_WITHOUT_A,     /* only if pdot = v */
};

/* Components of a state in independent velocities, if they are entries of p and v: all or some entries of p, then some of v. */
typedef struct zd_entries {
    const int *q;           /* (nv - mh,): indices of entries of p; NULL: all */
    const int *u;           /* (nv - m,): indices of entries of v */
    double steepest;        /* largest entry of D, characteristic scales, for which they are kept; beyond, they are chosen anew */
} zd_entries;

typedef struct zd_formulation {
    zd_card card;
    int drifts_from;        /* ZD_PHI, ZD_C: the constraints (3), (5) that its solutions drift from */
    int inverts_mass;       /* 1: M must be positive definite; 0: only on the velocities that satisfy the constraints */
    enum zd_many many_constraints;   /* support of declared structures with many constraints without dense matrices */
    int has_matrices_evaluated; /* 1: factor() of such a structure evaluates M and C itself, if needed */
    int (*suits)(const zd_system *system);      /* true if the system is supported; NULL: all are */
    /* The system of both has only the independent constraints. */
    int (*state_size)(const zd_system *system);
    void *(*create)(zd_arena *arena, const zd_system *system, const void *given);     /* given: values of the card's parameters */
    /* Factors the leading matrix at the point, from M and the independent rows of C. */
    int (*factor)(void *self, zd_point *point);
    /* True if factor() of this system itself shows the independence of the constraints, as it orthogonalizes them; NULL: it never does. */
    int (*finds_independent)(const zd_system *system);
    /* Solves M x + C^T lambda = force, C x = rhs with the factors. force NULL: zero; lambda NULL: not required. */
    void (*solve)(void *self, const double *force, const double *rhs, double *x, double *lambda);
    int (*unpack)(void *self, zd_point *point, double t, const double *y);   /* state -> (p, v) of the point */
    int (*pack)(void *self, zd_point *point, double *y);                   /* (p, v) of the point -> state */
    /* As pack(), but never chooses new variables; NULL together with update(). */
    int (*express)(void *self, zd_point *point, double *y);
    /* Sets v of the point from its p and the state; NULL if v is part of the state. */
    int (*update)(void *self, zd_point *point);
    /* For such formulations: true if the state can consist of entries of p and v, as closed-form functions require; and if it does,
     * their indices. NULL together with update(). */
    int (*may_have_entries)(const zd_system *system);
    int (*entries)(const void *self, zd_entries *entries);
    int (*rate)(void *self, zd_point *point, double *ydot);                 /* needs the acceleration */
    /* For the Jacobian of the rate; NULL if the state is (p, v) or update() is NULL. T (size, nq + nv) <- derivatives of p and v with
     * respect to each entry of the state, at the point: first those of p with respect to its first entries, the coordinates, whose number
     * is *positions; then all others, with the derivatives Psi_along (positions, m) of (5) along these p. A nonzero return: they are not
     * available there. pick(): ydot (size,) <- rate of the state, from the rates of p and v. */
    int (*tangents_of_p)(void *self, zd_point *point, double *T, int *positions);
    int (*tangents_of_v)(void *self, zd_point *point, const double *Psi_along, double *T);
    void (*pick)(const void *self, const zd_point *point, const double *pdot, const double *vdot, double *ydot);
} zd_formulation;

/* True if no dense matrices are formed for this system: see ZD_MAX_DENSE_CONSTRAINTS. */
static inline int zd_has_many_constraints(const zd_formulation *self, const zd_system *system)
{
    const int takes = self->many_constraints == ZD_MANY_CONSTRAINTS
                   || (self->many_constraints == ZD_MANY_CONSTRAINTS_WITHOUT_A && !(system->provides & ZD_A));
    return takes && zd_rank_is_of_many(system);
}

/* State (p, v) of the dependent formulations (8), (9), (13), which drifts from (3) and (5). */

int zd_dependent_state_size(const zd_system *system);
int zd_dependent_unpack(void *self, zd_point *point, double t, const double *y);
int zd_dependent_pack(void *self, zd_point *point, double *y);
int zd_dependent_rate(void *self, zd_point *point, double *ydot);

#define ZD_DEPENDENT_STATE                         \
    .drifts_from = ZD_PHI | ZD_C,                     \
    .state_size = zd_dependent_state_size,         \
    .unpack = zd_dependent_unpack,                   \
    .pack = zd_dependent_pack,                   \
    .rate = zd_dependent_rate
