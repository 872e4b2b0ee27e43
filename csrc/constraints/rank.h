/* Which rows of C count. Where some follow from others, all formulations work with an independent choice of them, and the
 * multipliers are shared out over all rows afterwards. Where rows follow from others that are independent elsewhere, a bifurcation,
 * their limits along the motion stand for them.
 */
#ifndef ZD_RANK_H
#define ZD_RANK_H

#include "../core.h"

/* Of lost rows: see branch.c. */
typedef struct zd_branch {
    int lost;           /* rows for which limits stand: the last of the holonomic ones in point->C */
    double *away;       /* (lost,): of path, in natural units, from the bifurcation */
    double speed;       /* in natural units, by which rates are taken */
    double t, *p, *v;   /* (nq,), (n,): where that is */
    double *pdot, *moved;       /* (nq,), (nq,) */
    double *Cdot, *xidot;       /* (m, n), (m,) */
    double *T, *K_rate;         /* (m, independent): of C_d and of wdot, what they have along the rows that count */
    double *w, *wdot;           /* (m, n): and what besides, in natural units */
    int rests;                  /* whether the point does */
    double *e, *x, *force;      /* (n,) each: from rest, its acceleration, the next one, f - d */
    double *K, *y;              /* (n + m, n + m), (n + m,) */
    int *order;                 /* (n + m,) */
} zd_branch;

struct zd_rank {
    int n, m, mh;
    int limit, holonomic_limit;     /* most rows that count, of all and of the holonomic: less than m, mh where some are redundant */
    double tolerance;   /* squared: of a row's length, below which it is no longer one */
    int may_drop;       /* whether fewer are taken as they come; else that is ZD_BIFURCATION */
    int begun;          /* whether the start is over: then that is told from rows that are redundant */
    int dropped;        /* whether that has happened, in this step */
    int near;           /* whether a closer look was needed, in this step */
    int *redundant;     /* (m,): whether the row was redundant at the start */
    int independent;    /* rows that are, here */
    int *row;           /* (m,): those rows, holonomic ones first, then those that follow from them */
    int *place;         /* (rows,): which of all rows stand where in point->C */
    double *length;     /* (m,): squares of the lengths of the rows at the start */
    double *C;          /* (rows, n): those that count */
    double *Q;          /* (m, n): rows being orthogonalized */
    double *G;          /* (m, m): what they had along each other, and then (rows beyond those that count) T: C_other = T C */
    double *whole, *left;   /* (m,): squares of their lengths, before and after */
    double *weight;     /* (m,): 1 / |row|^2 */
    double *K;          /* (rows, rows): factored; see share_out() */
    double *L;          /* (n, n): of M */
    double *rhs, *lambda;   /* (rows,) */
    double *sample;     /* (2 n + m m + m,): for the start */
    double *R;          /* (independent, independent): C_r = R Q, of zd_rank_set_basis() */
    zd_branch branch;
};

/* A row is one of the others where less than this share of its length is left when they are taken out, both plainly and in the metric
 * of M^-1, that is: both whatever the masses and whatever the units of the coordinates. As near as s to a bifurcation, its branches
 * are as far as s from each other, and Phi differs by s^2: so they cannot be told apart with less than the root of the rounding. */
#define ZD_RANK_TOLERANCE 0x1p-23
/* In whose neighbourhood limits serve better than rows, if it is one: see branch.c. */
#define ZD_BRANCH_REGION 0x1p-13
/* Rows of which this share is left, plainly, need no closer look. */
#define ZD_DOUBTFUL 0x1p-10

zd_rank *zd_rank_take(zd_arena *arena, const zd_system *system);
/* Finds the rank at the start, and from (6) whether rows that follow from others contradict them, do so wherever the system goes (they
 * are redundant), or only here (a bifurcation). A system without (6) is not asked. */
int zd_rank_start(zd_point *point, const zd_settings *settings);
/* Which rows count at the point, into point->rows, point->C. */
int zd_rank_find(zd_point *point);
/* Whether all rows count as they are. */
static inline int zd_rank_is_full(const zd_point *point)
{
    return point->C == point->terms.C;
}
/* Which row of all stands there among those that count. */
static inline int zd_rank_row(const zd_point *point, int k)
{
    return zd_rank_is_full(point) ? k : point->rank->place[k];
}
/* x, of this row, in natural units. */
void zd_rank_scale(const zd_point *point, int row, double *x);
/* Q <- an orthonormal basis of the independent rows in natural units. */
void zd_rank_set_basis(const zd_point *point);
/* The formulation's solve, with right sides and multipliers of all rows. */
void zd_rank_solve_reduced(const zd_point *point, const zd_formulation *formulation, void *solver, const double *force,
                           const double *rhs, double *x, double *lambda);
static inline void zd_rank_solve(const zd_point *point, const zd_formulation *formulation, void *solver, const double *force,
                                 const double *rhs, double *x, double *lambda)
{
    if (zd_rank_is_full(point)) formulation->solve(solver, force, rhs, x, lambda);
    else zd_rank_solve_reduced(point, formulation, solver, force, rhs, x, lambda);
}
/* The rows that are redundant, increasing; their number. */
int zd_rank_redundant(const zd_rank *self, int *rows);
/* "row 2 follows", "rows 0 and 2 follow": those that do not count, at the point */
void zd_rank_name_rows(const zd_point *point, char *to, size_t size);

/* branch.c: puts limits for the rows that are lost at the point among those that count, if there are such limits. */
int zd_branch_find(zd_point *point);
/* The same again, as the velocity is another. */
int zd_branch_turn(zd_point *point);
/* What stands for the lost rows in a right side (m,) for all rows: of xi, of Phi, of Psi, or of -Phi_t. */
enum zd_limit { ZD_LIMIT_XI, ZD_LIMIT_PHI, ZD_LIMIT_PSI, ZD_LIMIT_ENFORCED };
int zd_branch_replace(zd_point *point, enum zd_limit what, double *rhs);
static inline int zd_rank_replace(zd_point *point, enum zd_limit what, double *rhs)
{
    return point->rank->branch.lost ? zd_branch_replace(point, what, rhs) : ZD_DONE;
}

#endif
