/* Which rows of C count. Where some follow from others, all formulations work with an independent choice of them, and the
 * multipliers are shared out over all rows afterwards. Where rows follow from others that are independent elsewhere, a bifurcation,
 * their limits along the motion stand for them.
 */
#ifndef ZD_RANK_H
#define ZD_RANK_H

#include <string.h>

#include "../point/point.h"

typedef struct zd_limits zd_limits;     /* limits.h */
typedef struct zd_rank_monitor zd_rank_monitor;         /* rank_monitor.h */
typedef struct zd_selection zd_selection;

/* What every run has. */
struct zd_rank {
    int n, m, mh;
    int most_rows, most_holonomic;  /* that count anywhere, of all and of the holonomic: less than m, mh where some are redundant */
    int is_large;           /* whether there are so many rows, of a declared structure, that none is looked at: see ZD_LOOKED_ROWS */
    unsigned char *left_out;    /* (m,) of such, whether the row followed from others at the start; NULL: none did */
    int may_be_deficient;   /* whether fewer than that may count at a point; else that is ZD_BIFURCATION */
    int is_started;         /* whether it is known which rows are redundant */
    int was_deficient;      /* whether fewer than that have counted at a point of this step */
    int was_doubtful;       /* whether rows had to be orthogonalized at a point of this step, as they might be dependent */
    int was_ill_conditioned;    /* whether so little of a row was left in this step that v = D u lost digits: see stepping/variables.c */
    int was_turned;         /* whether rows may have come to lie reversed, as beyond a bifurcation, since this was last 0 */
    int lost;               /* rows for which limits stand: the last of the holonomic ones in point->C */
    int is_aside;           /* whether the points are those of steps that are none of the run's: what is kept from step to step stays */
    double *start_square;   /* (m,): squared lengths of the rows at the start */
    double *terms_square;   /* (m,): squared magnitudes of the terms that the entries of the rows are sums of; where not known, start_square */
    double *rhs;            /* (m,): for formulations that give the point its velocity; else NULL */
    zd_rank_monitor *monitor;          /* NULL where there are few rows, or the formulation's factorization tells that they are independent */
    zd_store *store;        /* the run's, for what it takes once rows may be dependent: */
    zd_selection *selection;    /* NULL until then */
    zd_rank_monitor *kept;          /* where some rows are redundant, the choice among them and how little it has changed; NULL until then */
};

/* An independent choice of rows, where some may follow from others. */
struct zd_selection {
    zd_rank *rank;
    int n, m, mh;
    double tolerance;       /* squared: the share of a row's length below which it follows from the others */
    int *redundant;         /* (m,): whether the row was redundant at the start */
    int independent;        /* how many rows are, at the point */
    int *row;               /* (m,): these rows, holonomic ones first, then those that follow from them */
    int *row_at;            /* (rows,): which of all rows stand where in point->C */
    double *C;              /* (rows, n): those that count */
    double *Q;              /* (m, n): rows being orthogonalized */
    double *G;              /* (m, m): products of the rows with those chosen; then, of rows not chosen, T in C_d = T C_r */
    double *strength;       /* (m,): squared lengths of the rows over those of the terms that they are sums of, at most 1 */
    double *square, *square_left;   /* (m,): squared lengths of the rows, and of what is left of them once others are taken out */
    double *weight;         /* (m,): 1 / |row|^2 */
    double *K;              /* (rows, rows): B^T W B, factored; see rank.c */
    double *L;              /* (n, n): Cholesky factor of M */
    double *rhs, *lambda;   /* (rows,) */
    int is_expressed;       /* whether G has T and K is factored: of a choice that was kept, once multipliers of all rows are wanted */
    int are_awaited;        /* whether those of the point's acceleration are not known yet, and `lambda_r` is */
    double *lambda_r;       /* (rows,) */
    double *R;              /* (independent, independent): C_r = R Q, of zd_rank_set_basis() */
    zd_limits *limits;      /* NULL until rows are lost that limits may stand for */
};

/* A row counts as dependent where less than this share of its length is left once the others are taken out of it by orthogonalization,
 * both in the plain metric, which does not depend on the masses, and in that of M^-1, which does not depend on the units of the
 * coordinates. The square root of the rounding is the smallest share there can be: at a distance s from a bifurcation its branches are
 * s apart, too, and their Phi differ by s^2 only. */
#define ZD_RANK_TOLERANCE 0x1p-23
/* Nearer to a bifurcation than this, in natural units, limits are more accurate than rows: see limits.c. */
#define ZD_LIMITS_REGION 0x1p-13
/* Rows of which this share is left in the plain metric are independent for certain. */
#define ZD_DOUBTFUL 0x1p-10
/* Where less than this share of a row is left, it determines velocities with noticeably fewer digits: see stepping/variables.c. */
#define ZD_ILL_CONDITIONED 0x1p-6

/* Of a system that declares its structure and has more rows or velocities, dense matrices would cost more than all else, and what is small
 * anywhere in it says nothing of the whole: bifurcations are not looked for, and rows that follow from others at the start are left out for
 * good. */
enum { ZD_LOOKED_ROWS = 40, ZD_LOOKED_VELOCITIES = 300 };
static inline int zd_rank_is_of_many(const zd_system *system)
{
    int rows = system->structure && system->nv > ZD_LOOKED_VELOCITIES ? ZD_LOOKED_ROWS + 1 : 0;
    for (int g = 0; system->structure && g < system->structure->groups && rows <= ZD_LOOKED_ROWS; g++) rows += system->structure->rows[g];
    return rows > ZD_LOOKED_ROWS;
}

/* Of the diagonal of M: smaller pivots make M^-1 no metric. */
#define ZD_LEAST_PIVOT 0x1p-44

/* `is_large`: whether nothing dense is made. */
zd_rank *zd_rank_take(zd_arena *arena, const zd_system *system, int is_large);
/* Has the memory for a choice; ZD_NO_MEMORY if there is none. */
int zd_rank_need_selection(zd_rank *self, const zd_system *system);
/* Chooses the rows that count at the point, with so much of their length left; C and M are known there. */
void zd_rank_choose(zd_point *point, double tolerance);
/* The rows that count are these (m,), the first of which are independent, as they were where they were chosen. */
void zd_rank_use(zd_point *point, const int *row, int independent);
/* All rows count at the point. */
void zd_rank_use_all(zd_point *point);
/* Whether all rows count as they are. */
static inline int zd_rank_is_full(const zd_point *point)
{
    return point->C == point->terms.C;
}
/* Which of all rows stands at place k among those that count. */
static inline int zd_rank_row(const zd_point *point, int k)
{
    return zd_rank_is_full(point) ? k : point->rank->selection->row_at[k];
}
/* selection->G has T of the rows that do not count; C is known, and no limits stand for rows. */
void zd_rank_express_others(const zd_point *point);
/* x, of this row, in natural units. */
void zd_rank_scale(const zd_point *point, int row, double *x);
/* Q <- an orthonormal basis of the independent rows in natural units. */
void zd_rank_set_basis(const zd_point *point);
/* lambda of all rows, the smallest, from those of the rows that count, which self->lambda has without those of limits; M and C are known */
void zd_rank_share_out(const zd_point *point, double *lambda);
/* point->lambda <- those of the acceleration there, if they were left until they are wanted. */
static inline void zd_rank_find_multipliers(const zd_point *point)
{
    zd_selection *self = point->rank ? point->rank->selection : NULL;
    if (!self || !self->are_awaited) return;
    memcpy(self->lambda, self->lambda_r, (size_t)self->independent * sizeof *self->lambda);
    zd_rank_share_out(point, point->lambda);
    self->are_awaited = 0;
}
/* Those that were left are given from elsewhere. */
static inline void zd_rank_forget_awaited(const zd_point *point)
{
    if (point->rank->selection) point->rank->selection->are_awaited = 0;
}
/* The rows that are redundant, increasing; their number. */
int zd_rank_redundant(const zd_rank *self, int *rows);
/* "row 2 follows", "rows 0 'A.x' and 2 'B.x' follow": those that do not count, at the point */
void zd_rank_name_rows(const zd_point *point, char *to, size_t size);

#endif
