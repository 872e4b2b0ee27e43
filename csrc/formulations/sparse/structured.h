/* Elimination for formulations in (p, v) of a declared structure with many constraints: no dense matrices, cost proportional to the
 * number of bodies. */
#pragma once

#include "../../constraints/rank.h"
#include "../../linalg/small.h"
#include "../../point/point.h"
#include "../../point/sparse/bodies.h"
#include "../../point/sparse/weighted.h"

/* Solution of M x + C^T lambda = force, C x = rhs by elimination of bodies, for singular M or redundant constraints. */

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

/* Schur complement C M^-1 C^T of (13) in sparse blocks, for block-diagonal M and rows of C that touch few blocks. */

typedef struct zd_schur_blocks {
    int n, m;
    zd_weighted *weighted;  /* S(M^-1); NULL until first needed */
    double *W;              /* stored as M: factors of M^-1 */
    int is_diagonal;        /* 1: M is diagonal */
    int is_constant;        /* 1: M is declared constant, so W is computed once; is_known: it has been */
    int is_known;
    double share;           /* smallest pivot of S relative to its diagonal entry, at the last factorization */
    int smallest;           /* index of that pivot in the order of S */
    int is_accurate;        /* 1: neither pivots nor mass ratios require solutions to be verified */
    int is_compared;        /* 1: solutions with the present factors are verified */
    int wait, pause;        /* number of factorizations until the next verification, and between the last two */
    double compared_share;  /* smallest pivot at the last verification */
    double *force;          /* (n,): force - C^T lambda */
    double *lambda;         /* (m,) */
    double *residual, *step;    /* (m,), (n,): residual rhs - C x, and its correction */
    double *least;          /* (m,), in the order of S: diagonal entries above it prove that the row is not small; NULL: unused */
    int is_least_known;
    const zd_operations *products;      /* the system's own products with C; NULL: none */
    const void *data;           /* their data and the terms at the point */
    zd_terms terms;
    zd_right_side begun;        /* right-hand side eliminated during factorization, until it is solved for; x NULL: none */
    const zd_layout *layout;    /* layout and C of the point at the factorization */
    const double *C;
    int has_redundant;          /* 1: some constraints are redundant */
    unsigned char *without;     /* (rows of S,): 1 for constraints left out */
    const zd_selection *chosen; /* selected constraints at the factorization; NULL: all */
    double *rhs_of_all, *lambda_of_all;     /* (m,) */
} zd_schur_blocks;

/* Returns NULL if the system declares no structure, or has redundant constraints and exceeds ZD_MAX_DENSE_CONSTRAINTS. */
zd_schur_blocks *zd_schur_blocks_create(zd_arena *arena, const zd_system *system);
/* Factors S; all constraints are independent at the point, or their selection is known, without limits. ZD_DEPENDENT_ROWS: S is singular
 * to rounding. */
int zd_schur_blocks_factor(zd_schur_blocks *self, zd_point *point);
/* zd_rows_are_long() at the factorization, from the diagonal of S if that is conclusive, else from C. */
int zd_schur_blocks_find_long_rows(zd_schur_blocks *self, zd_point *point);
static inline int zd_schur_blocks_has_long_rows(zd_schur_blocks *self, zd_point *point)
{
    const int is_known = self->is_least_known && point->rank->is_started;
    return (is_known && zd_all_exceed(self->m, self->weighted->blocks->diagonal, self->least)) || zd_schur_blocks_find_long_rows(self, point);
}
/* solve() of formulation.h, for the selected constraints. */
void zd_schur_blocks_solve(zd_schur_blocks *self, const double *force, const double *rhs, double *x, double *lambda);

/* Distance of a structure with redundant constraints from a bifurcation. Such a structure is solved by bodywise.c, which has no pivots
 * of constraints; so C M^-1 C^T of the independent constraints alone is factored here for its smallest pivot. */

typedef struct zd_singularity_monitor {
    zd_weighted *weighted;      /* S(M^-1) */
    double *W;                  /* stored as M: factors of M^-1 */
    unsigned char *without;     /* (rows of S,): 1 for constraints left out */
    double share;               /* smallest pivot relative to its diagonal entry, at the last update */
    int smallest;               /* index of that pivot in the order of S */
} zd_singularity_monitor;

/* Returns NULL without memory. */
zd_singularity_monitor *zd_singularity_monitor_create(zd_store *store, const zd_point *point);
/* Updates the smallest pivot; M and C are known at the point. Returns 0, without an update, if M is not definite. */
int zd_singularity_monitor_update(zd_singularity_monitor *self, const zd_point *point);

typedef struct zd_structured {
    zd_schur_blocks *blocks;
    zd_bodywise *bodywise;      /* used if M is singular or constraints are redundant; NULL until then */
    zd_singularity_monitor *monitor;        /* distance to a bifurcation in that case */
    int is_coupled;             /* 1: blocks were factored; 0: bodywise */
} zd_structured;

/* Returns NULL unless the system exceeds ZD_MAX_DENSE_CONSTRAINTS. */
zd_structured *zd_structured_create(zd_arena *arena, const zd_system *system);
/* Factors the leading matrix at the point; `inverts_mass`: M must be positive definite. */
int zd_structured_factor(zd_structured *self, zd_point *point, int inverts_mass);
/* solve() of formulation.h. */
void zd_structured_solve(zd_structured *self, const double *force, const double *rhs, double *x, double *lambda);
