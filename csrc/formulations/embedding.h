/* Embedding p = g(q), (18): all coordinates from independent ones, by the system's own function or numerically. */
#pragma once

#include "../point/point.h"

/* Independent coordinates with unit quaternions, where p is longer than v: displacement of p from a base, in the directions of the
 * velocities. */

typedef struct zd_increments {
    int nq, nv;             /* 0, 0: unused, as there are no quaternions */
    double *base;           /* (nq,): p at the start of the step */
    double *inverse;        /* (nv, nq): A(base)^+ */
    double *gram;           /* (nv, nv) */
    double *rounding;       /* (nv,): rounding error of each increment, from that of p */
} zd_increments;

zd_increments zd_increments_create(zd_arena *arena, const zd_system *system);
/* Sets the base to the p of the point. */
int zd_increments_begin(zd_increments *self, zd_point *point);
/* True if p is near enough to the base for the increments to determine it. */
int zd_increments_are_within_reach(const zd_increments *self, const zd_system *system, const double *p);
/* Increment of p in the direction of velocity j; and its rate, from that of p. */
double zd_increments_value(const zd_increments *self, const zd_point *point, const double *p, int j);
double zd_increments_rate(const zd_increments *self, const double *pdot, int j);
/* row (nv,): the rate of increment j is row . v at the point; needs A. */
void zd_increments_row(const zd_increments *self, const zd_point *point, int j, double *row);

typedef struct zd_embedding {
    int nq, nv, mh, k;      /* mh: number of independent holonomic constraints */
    zd_embed *embed;        /* the system's own g; NULL: none, or not applicable, as constraints are redundant */
    int chosen;             /* 1: q has been selected */
    double reference;       /* condition of q when it was selected */
    double rounding;        /* rounding of Phi */
    int *index;             /* (k,): indices of the entries of p, or of the increments, that are q */
    zd_increments increments;   /* used with unit quaternions */
    int *order;             /* (mh + nq,) */
    double *memory;         /* (m, nv): dense C, if the system's own is packed */
    const double *C;        /* (m, nv): independent rows of C */
    double *K;              /* (nv, nv): factors of [C_H; A_q], where qdot = A_q v */
    int *pivots;            /* (nv,) */
    double *choice;         /* (nv, mh + nq): work space of the selection of q, of K and what follows it */
    double *delta;          /* (nv,) */
    double *p;              /* (nq,) */
} zd_embedding;

zd_embedding zd_embedding_create(zd_arena *arena, const zd_system *system);
/* Work space (m, nv), free except while q is selected. */
double *zd_embedding_workspace(const zd_embedding *self);
/* q (k,) of the point, and qdot (k,) from pdot. */
void zd_embedding_coordinates(const zd_embedding *self, const zd_point *point, double *q);
void zd_embedding_rates(const zd_embedding *self, const double *pdot, double *qdot);
/* Moves the point to p = g(q) at time t, starting from its present p. */
int zd_embedding_place(zd_embedding *self, zd_point *point, double t, const double *q);
/* First nq entries of each row of T (k, width) <- derivative of p with respect to that entry of q; at the point, p = g(q). */
int zd_embedding_tangents(zd_embedding *self, zd_point *point, int width, double *T);
/* Largest derivative of a coordinate with respect to q, characteristic scales, for which q is kept; 0: q is not selected. */
double zd_embedding_steepest(const zd_embedding *self);
/* Selects q anew if it is badly conditioned at the point; *changed: it was. */
int zd_embedding_review(zd_embedding *self, zd_point *point, int *changed);
