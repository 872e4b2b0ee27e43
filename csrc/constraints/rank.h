/* Independent and redundant constraints.
 * Where constraints are linearly dependent, all formulations use an independent subset C_r, and the multipliers are distributed over all
 * constraints afterwards. At a bifurcation, constraints become dependent that are independent elsewhere; there their limits along the
 * motion (limits.h) replace them.
 */
#pragma once

#include <string.h>

#include "../point/point.h"

typedef struct zd_limits zd_limits;     /* limits.h */
typedef struct zd_rank_monitor zd_rank_monitor;         /* rank_monitor.h */
typedef struct zd_selection zd_selection;

/* Rank of C: state of one run. */
struct zd_rank {
    int n, m, mh;
    int max_rank, max_rank_holonomic;  /* maximum number of independent constraints, all and holonomic; below m, mh if some are redundant */
    int is_large;           /* 1: the declared structure exceeds ZD_MAX_DENSE_CONSTRAINTS; dependence is checked at the start only */
    unsigned char *left_out;    /* (m,) if is_large: 1 for constraints found redundant at the start; NULL: none */
    int allows_deficiency;   /* 1: fewer independent constraints are tolerated at a point; 0: they raise ZD_BIFURCATION */
    int is_started;         /* 1: redundant constraints have been determined */
    int was_deficient;      /* 1: fewer were independent at some point of this step */
    int was_doubtful;       /* 1: possible dependence at a point of this step required an orthogonalization */
    int was_ill_conditioned;    /* 1: v = D u lost digits in this step, as a residual norm was small: see state/variables.c */
    int was_turned;         /* 1: the row space of C may have reversed, as beyond a bifurcation, since the flag was cleared */
    int lost;               /* number of constraints replaced by limits: the last holonomic rows of point->C */
    int is_auxiliary;           /* 1: points belong to auxiliary steps; the selection kept from step to step is not changed */
    double *start_square;   /* (m,): squared lengths of the rows at the start */
    double *terms_square;   /* (m,): squared magnitudes of the terms summed in each row; where not known, start_square */
    double *rhs;            /* (m,): right-hand side, for formulations that compute the velocity; else NULL */
    zd_rank_monitor *monitor;          /* monitor of all constraints; NULL if is_large, or for few dense ones */
    zd_store *store;        /* memory for symbolic structures, made when they are first needed */
    zd_selection *selection;    /* NULL if is_large */
    zd_rank_monitor *kept;          /* monitor of the selection kept from step to step, and of its change; NULL if none is redundant */
};

/* Selection of independent constraints where some are linearly dependent. */
struct zd_selection {
    zd_rank *rank;
    int n, m, mh;
    double tolerance;       /* squared: relative residual norm below which a row is dependent on the others */
    int *redundant;         /* (m,): 1 for constraints found redundant at the start */
    int independent;        /* number of independent constraints at the point */
    int *row;               /* (m,): indices of the independent constraints, holonomic ones first, then of the dependent ones */
    int *row_at;            /* (rows,): index of the constraint in each row of point->C */
    double *C;              /* (rows, n): C_r, the independent rows of C */
    double *Q;              /* (m, n): rows during the orthogonalization, then its basis */
    double *G;              /* (m, m): products of all rows with the basis; then, in dependent rows, T of C_d = T C_r */
    double *strength;       /* (m,): squared row norms over the squared magnitudes of their terms, at most 1 */
    double *square, *square_left;   /* (m,): squared norms of the rows, and of their residuals after orthogonalization */
    double *weight;         /* (m,): 1 / |row|^2 */
    double *K;              /* (rows, rows): B^T W B, factored; see rank.c */
    double *L;              /* (n, n): Cholesky factor of M */
    double *rhs, *lambda;   /* (rows,) */
    int is_expressed;       /* 1: G holds T and K is factored, as needed for the multipliers of all constraints */
    int are_awaited;        /* 1: multipliers of the point's acceleration are pending; lambda_r holds the independent ones */
    double *lambda_r;       /* (rows,) */
    double *R;              /* (independent, independent): C_r = R Q, of zd_rank_set_basis() */
    zd_limits *limits;      /* NULL for a motion that ends at a bifurcation */
};

/* Relative residual norm below which a row is linearly dependent on the others. It must hold both in the plain metric, which does not
 * depend on the masses, and in that of M^-1, which does not depend on the units of the coordinates. The square root of the rounding is
 * the smallest value possible: at a distance s from a bifurcation its branches are s apart, too, and their Phi differ by s^2 only. */
#define ZD_RANK_TOLERANCE 0x1p-23
/* Distance from a bifurcation, in characteristic scales, below which limits are more accurate than the constraints themselves: see
 * limits.c. */
#define ZD_LIMITS_REGION 0x1p-13
/* Relative residual norm in the plain metric above which rows are certainly independent. */
#define ZD_DOUBTFUL 0x1p-10
/* Relative residual norm below which a constraint determines velocities with noticeably fewer digits: see state/variables.c. */
#define ZD_ILL_CONDITIONED 0x1p-6

/* Largest number of constraints and of velocities of a declared structure for which dense matrices are formed. Beyond, they would
 * dominate the cost, and a small pivot anywhere says nothing about the whole system: bifurcations are not detected, and constraints that
 * are redundant at the start are left out for good. */
enum { ZD_MAX_DENSE_CONSTRAINTS = 40, ZD_MAX_DENSE_VELOCITIES = 300 };
static inline int zd_rank_is_of_many(const zd_system *system)
{
    int rows = system->structure && system->nv > ZD_MAX_DENSE_VELOCITIES ? ZD_MAX_DENSE_CONSTRAINTS + 1 : 0;
    const int groups = system->structure ? system->structure->groups : 0;
    for (int g = 0; g < groups && rows <= ZD_MAX_DENSE_CONSTRAINTS; g++) rows += system->structure->rows[g];
    return rows > ZD_MAX_DENSE_CONSTRAINTS;
}

/* Smallest pivot of M relative to its diagonal for which M^-1 serves as a metric. */
#define ZD_MIN_PIVOT 0x1p-44

/* `is_large`: no dense matrices are allocated. */
zd_rank *zd_rank_create(zd_arena *arena, const zd_system *system, int is_large);
/* Selects the independent constraints at the point with the (squared) tolerance; C and M are known there. */
void zd_rank_choose(zd_point *point, double tolerance);
/* Selects the first `independent` constraints of row (m,), as they were selected at an earlier point. */
void zd_rank_use(zd_point *point, const int *row, int independent);
/* Selects all constraints at the point. */
void zd_rank_use_all(zd_point *point);
/* True if all constraints are selected. */
static inline int zd_rank_is_full(const zd_point *point)
{
    return point->C == point->terms.C;
}
/* True if some constraints depend on others at the point, so that its multipliers are a choice. */
static inline int zd_rank_is_deficient(const zd_point *point)
{
    return point->rank && (point->rank->lost || point->rows < point->rank->m);
}
/* Index of the constraint in row k of point->C. */
static inline int zd_independent_constraint(const zd_point *point, int k)
{
    return zd_rank_is_full(point) ? k : point->rank->selection->row_at[k];
}
/* Sets T of the dependent constraints in selection->G; C is known, and no limits replace constraints. */
void zd_rank_express_others(const zd_point *point);
/* x (n,), a gradient of this constraint, scaled to characteristic scales. */
void zd_rank_scale(const zd_point *point, int row, double *x);
/* Q <- an orthonormal basis of the independent rows in characteristic scales. */
void zd_rank_set_basis(const zd_point *point);
/* lambda (m,) of all constraints, of minimum norm, from those of the independent ones in self->lambda (without limits); M and C are
 * known. */
void zd_rank_share_out(const zd_point *point, double *lambda);
/* point->lambda <- the pending multipliers of the acceleration there, if any. */
static inline void zd_rank_find_multipliers(const zd_point *point)
{
    zd_selection *self = point->rank ? point->rank->selection : NULL;
    if (!self || !self->are_awaited) return;
    zd_copy_all(self->independent, self->lambda_r, self->lambda);
    zd_rank_share_out(point, point->lambda);
    self->are_awaited = 0;
}
/* Discards pending multipliers, which are provided otherwise. */
static inline void zd_rank_discard_awaited(const zd_point *point)
{
    if (point->rank->selection) point->rank->selection->are_awaited = 0;
}
/* Writes the indices of the redundant constraints in increasing order; returns their number. */
int zd_rank_redundant(const zd_rank *self, int *rows);
/* Text such as "row 2 follows" or "rows 0 'A.x' and 2 'B.x' follow": the dependent constraints at the point. */
void zd_rank_name_rows(const zd_point *point, char *to, size_t size);

/* Selection of the independent constraints at a point: all of them, an independent subset, or one in which limits replace constraints
 * that are lost at a bifurcation.
 *
 * At an ordinary point a quick check shows that all are independent: the products of two rows; the pivots that a formulation computes
 * anyway; or the change since the last full check. */

enum { ZD_FEW_CONSTRAINTS = 2 };       /* largest number of constraints checked by their products */

/* Finds the independent constraints at the point; sets point->rows, point->C. */
int zd_find_independent(zd_point *point);
/* Discards a selection kept from an earlier point, so that the next zd_find_independent() selects anew; returns 0 without one. */
int zd_discard_selection(zd_point *point);
/* Selects again after a change of the velocity, along which limits are taken. */
int zd_rows_find_again(zd_point *point);

/* For formulations that check independence themselves: true if no row has shrunk to nearly zero at the point; selection of all
 * constraints. */
int zd_rows_are_long(const zd_point *point);
void zd_use_all_constraints(zd_point *point);

/* Classification of dependent constraints at the start. */

/* Measures the constraints; must precede the first selection. */
int zd_redundancy_prepare(zd_point *point);
/* Finds the rank at the start, and from (6) whether dependent constraints contradict the others, are redundant (dependent everywhere),
 * or are dependent only here (a bifurcation). If the system does not provide xi of (6), they are not classified. */
int zd_redundancy_find(zd_point *point, enum zd_on_singular on_singular);

/* Redundant constraints of a declared structure with many constraints. */

/* Records them in point->rank; C is known there. ZD_CONTRADICTION: no acceleration satisfies them together with the others;
 * ZD_BIFURCATION: one of them is dependent in this position only. */
int zd_redundancy_sparse_find(zd_point *point);
