/* A row of the table of formulations: a leading matrix and its solve, and the state that is integrated. */
#ifndef ZD_FORMULATION_H
#define ZD_FORMULATION_H

#include "../constraints/rank.h"

enum zd_many {
    ZD_FEW_ROWS_ONLY,
    ZD_MANY_ROWS,
    ZD_MANY_ROWS_WITHOUT_A,     /* where pdot = v */
};

/* What a state in independent velocities is made of, where that is entries of p and v: behind all of p, or some of it, some of v. */
typedef struct zd_entries {
    const int *q;           /* (nv - mh,): entries of p; NULL: all */
    const int *u;           /* (nv - m,): of v */
    double steepest;        /* entry of D, in natural units, that they are kept up to, and not chosen anew */
} zd_entries;

typedef struct zd_formulation {
    zd_card card;
    int drifts_from;        /* ZD_PHI, ZD_C: which of (3), (5) its solutions drift from */
    int inverts_mass;       /* whether M has to be definite; else M is only where the constraints leave the velocities free */
    enum zd_many takes_many_rows;   /* whether it does without dense matrices where a declared structure has many rows */
    int has_matrices_evaluated; /* whether factor() of a structure of many rows has M and C evaluated itself, where it needs them */
    int (*suits)(const zd_system *system);      /* NULL: it takes any */
    /* Both are told of as many constraints as are independent. */
    int (*state_size)(const zd_system *system);
    void *(*take)(zd_arena *arena, const zd_system *system, const void *given);     /* given: the parameters that its card lists */
    /* The leading matrix at the point, from M and the rows of C that count. */
    int (*factor)(void *self, zd_point *point);
    /* Whether factor() of such a system tells by itself, as it orthogonalizes them, that all rows count; NULL: it does not. */
    int (*finds_rows)(const zd_system *system);
    /* Workspace that factor() does not use before it is known which rows count, and that the search for these may write into meanwhile:
     * Q (m, n) and G (m, m), m <= n. NULL: there is none. */
    void (*lend_workspace)(void *self, double **Q, double **G);
    /* M x + C^T lambda = force, C x = rhs, with what was factored. force NULL: zero; lambda NULL: not wanted. */
    void (*solve)(void *self, const double *force, const double *rhs, double *x, double *lambda);
    int (*enter)(void *self, zd_point *point, double t, const double *y);   /* state -> (p, v) of the point */
    int (*leave)(void *self, zd_point *point, double *y);                   /* (p, v) of the point -> state */
    /* The same without choosing variables anew, which leave() may do; NULL together with settle(). */
    int (*express)(void *self, zd_point *point, double *y);
    /* Gives the point the v that follows from its p and the state; NULL where v is part of the state. */
    int (*settle)(void *self, zd_point *point);
    /* Of such formulations: whether the state can be entries of p and v, as direct functions of the system have it; and whether it is, and
     * which. NULL together with settle(). */
    int (*may_have_entries)(const zd_system *system);
    int (*entries)(const void *self, zd_entries *entries);
    int (*rate)(void *self, zd_point *point, double *ydot);                 /* needs the acceleration */
    /* For the Jacobian of the rate, where the state is not (p, v); NULL where settle() is. T (size, nq + nv) <- the derivatives
     * of p and v by each entry of the state, at the point, where Psi_p (m, nq) are those of (5) by p; not 0: they are not known there.
     * ydot (size,) <- the entries of the state's rate, given the rates of p and v. */
    int (*tangents)(void *self, zd_point *point, const double *Psi_p, double *T);
    void (*pick)(const void *self, const zd_point *point, const double *pdot, const double *vdot, double *ydot);
} zd_formulation;

/* Whether nothing dense is made of this system: see ZD_MAX_DENSE_ROWS. */
static inline int zd_takes_many_rows(const zd_formulation *self, const zd_system *system)
{
    const int takes = self->takes_many_rows == ZD_MANY_ROWS
                   || (self->takes_many_rows == ZD_MANY_ROWS_WITHOUT_A && !(system->provides & ZD_A));
    return takes && zd_rank_is_of_many(system);
}

#endif
