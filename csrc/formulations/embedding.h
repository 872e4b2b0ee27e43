/* p = g(q), (18): all coordinates from independent ones. The system's own function, or numerically. */
#ifndef ZD_EMBEDDING_H
#define ZD_EMBEDDING_H

#include "increments.h"

typedef struct zd_embedding {
    int nq, nv, mh, k;      /* mh: holonomic rows that count */
    zd_embed *embed;        /* the system's own g; NULL: there is none, or it is for more rows */
    int chosen;             /* whether q has been */
    double reference;       /* how well q was conditioned when it was */
    double rounding;        /* of Phi */
    int *index;             /* (k,): which entries of p are q, or which increments */
    zd_increments increments;   /* where there are unit quaternions */
    int *order;             /* (mh + nq,) */
    double *memory;         /* (m, nv): of C, where the system's own is packed */
    const double *C;        /* (m, nv): the rows that count */
    double *K;              /* (nv, nv): [C_H; A_q], factored, where A_q gives qdot of v */
    int *pivots;            /* (nv,) */
    double *choice;         /* (nv, mh + nq): where q is chosen, K and what follows it */
    double *delta;          /* (nv,) */
    double *p;              /* (nq,) */
} zd_embedding;

zd_embedding zd_embedding_take(zd_arena *arena, const zd_system *system);
/* Memory (m, nv) that is free but while q is chosen. */
double *zd_embedding_workspace(const zd_embedding *self);
/* q (k,) where the point is, and its rate where p has that. */
void zd_embedding_coordinates(const zd_embedding *self, const zd_point *point, double *q);
void zd_embedding_rates(const zd_embedding *self, const double *pdot, double *qdot);
/* Moves the point to p = g(q) at time t, starting from where it is. */
int zd_embedding_place(zd_embedding *self, zd_point *point, double t, const double *q);
/* At the point, where p = g(q): the first nq of each row of T (k, width) <- what p changes by with that entry of q. */
int zd_embedding_tangents(zd_embedding *self, zd_point *point, int width, double *T);
/* The largest response of a coordinate to q, in natural units, that q is kept up to; 0: q is not chosen. */
double zd_embedding_steepest(const zd_embedding *self);
/* Chooses q anew where the present choice is badly conditioned at the point; *changed tells. */
int zd_embedding_review(zd_embedding *self, zd_point *point, int *changed);

#endif
