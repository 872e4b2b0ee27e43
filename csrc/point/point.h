/* A point of the motion: all that is known at one (t, p, v), computed when it is first wanted and never twice. */
#ifndef ZD_POINT_H
#define ZD_POINT_H

#include "layout.h"
#include "terms.h"

#define ZD_BIT_OF_VELOCITY(name, bit, member, shape, depends, text) | ((depends) == ZD_OF_POSITIONS ? 0 : (bit))
enum {                                  /* known beside the system's own terms */
    ZD_FACTORED = 1 << 24,              /* the formulation's leading matrix, at this (t, p) */
    ZD_ACCELERATED = 1 << 25,           /* vdot and lambda, at this (t, p, v) */
    ZD_COMPLEMENTED = 1 << 26,          /* the complement D and what goes with it, at this (t, p) */
    ZD_RANKED = 1 << 27,                /* which rows of C count, at this (t, p) */
    ZD_OF_VELOCITY = ZD_ACCELERATED ZD_TERM_LIST(ZD_BIT_OF_VELOCITY)    /* what is not known any more where v changes */
};

typedef struct zd_rank zd_rank;         /* constraints/rank.h */

/* Of a solve of formulation.h, and where its x goes. */
typedef struct zd_right_side {
    const double *force, *rhs;
    double *x;
} zd_right_side;

typedef struct zd_point {
    const zd_system *system;
    zd_statistics *statistics;
    const zd_layout *layout;    /* of A, M and C; NULL where they are dense */
    int known;              /* what of all this is valid now */
    int constant;           /* ZD_M, where it stays valid wherever the point moves */
    double t, *p, *v;
    zd_terms terms;
    double *vdot, *lambda;  /* (nv,), (m,) */
    double *force, *rhs;    /* (nv,), (m,): right sides being put together */
    zd_right_side awaited;  /* what a solve follows with, for a factorization that can begin with it; x NULL: it is not known */
    zd_rank *rank;          /* NULL where the point only serves to evaluate terms */
    int rows, holonomic;    /* rows of C that count (m, unless some follow from others), and the holonomic ones, which come first */
    const double *C;        /* those that count: the system's own, stored as they are, or dense (rows, nv) */
    double *unit, *inverse_unit;    /* (nv,): natural size of what each velocity is the rate of, see units.c; and 1 / unit */
    double *inverse_unit_p;         /* (nq,): 1 / the same of the coordinates */
    double *size;           /* (m,): of the rows of C, and so of Phi, in these units */
    double *inverse_size;       /* (m,): 1 / size */
    double *rounding;       /* (m,): lengths of rows of C at and below which they are the rounding of terms that cancel; 0: not known */
    int measured;           /* whether these are known */
    int failed_index, failed_column;    /* the coordinate or row that a failed factorization names; of an asymmetric M, the column, too */
    double residual_left;   /* what a failed iteration was left with */
} zd_point;

zd_point *zd_point_take(zd_arena *arena, const zd_system *system, zd_statistics *statistics);
void zd_point_move(zd_point *point, double t, const double *p, const double *v);
void zd_point_move_position(zd_point *point, const double *p);
void zd_point_move_velocity(zd_point *point, const double *v);
int zd_point_need_missing(zd_point *point, int missing);
void zd_point_force(const zd_point *point, double *force);          /* f - d */
static inline double zd_point_potential(const zd_point *point) { return point->terms.V ? *point->terms.V : 0; }     /* needs V */
int zd_point_is_finite(const zd_point *point);      /* its p and v */

/* Has the terms in `want` computed, those that the system has and that are not known yet. */
static inline int zd_point_need(zd_point *point, int want)
{
    int missing = want & point->system->provides & ~point->known;
    return missing ? zd_point_need_missing(point, missing) : ZD_DONE;
}

#endif
