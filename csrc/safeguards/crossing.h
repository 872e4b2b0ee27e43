/* Whether a bifurcation lies within a step. */
#ifndef ZD_CROSSING_H
#define ZD_CROSSING_H

#include "../motion/motion.h"
#include "../motion/place.h"

typedef struct zd_crossing {    /* the rows of C where the step began, to see what has become of them */
    zd_motion *motion;
    const zd_last *last;    /* the step */
    const double *rate0, *rate1;    /* (nq,): pdot at its ends */
    int kept;               /* whether there are such */
    int passes;             /* whether the step may pass a bifurcation */
    int holds;              /* whether the constraints of position hold at the end of every step */
    double *C;              /* (m, nv), times the squares of the natural units */
    double *before;         /* likewise, at the last look */
    double *p, *p1, *v1;    /* (nq,), (nq,), (nv,): where one is, and the end */
    double *turn;           /* (m, m) */
    int *order;             /* (m,) */
} zd_crossing;

zd_crossing zd_crossing_take(zd_arena *arena, zd_motion *motion, const zd_last *last);
int zd_crossing_begin(zd_crossing *self);       /* keeps where the motion is */
/* Keeps where a step of size h has led, by so much in natural units, squared; ZD_PASSED if a bifurcation lies in between. */
int zd_crossing_step(zd_crossing *self, double h, double moved);
/* Whether the point is at a bifurcation. */
int zd_crossing_is_at_one(const zd_point *point);
/* det(C1 W C0^T), of the rows that count at the point, C0 being those that are kept: its sign changes where a bifurcation is passed. */
double zd_crossing_orientation(const zd_crossing *self);

#endif
