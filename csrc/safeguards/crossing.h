/* Whether a bifurcation lies within a step. */
#ifndef ZD_CROSSING_H
#define ZD_CROSSING_H

#include "../motion/motion.h"
#include "../motion/place.h"

/* Memory for a closer look at a step. */
typedef struct zd_crossing_memory {
    double *C;              /* the rows where the step began, stored as the point's are, times the squares of the natural units */
    double *previous;       /* likewise, at the point looked at before */
    double *p, *p1, *v1;    /* (nq,), (nq,), (nv,): the point looked at, and the end of the step */
    double *turn;           /* (m, m): C1 W C0^T, factored */
    int *order;             /* (m,) */
    double *scratch;        /* the system's own */
} zd_crossing_memory;

typedef struct zd_crossing {
    zd_motion *motion;
    const zd_last *last;    /* the step */
    const double *rate0, *rate1;    /* (nq,): pdot at its ends */
    int has_begun;          /* whether the step began anywhere but at a bifurcation */
    int may_pass;           /* whether the step may pass a bifurcation */
    int constraints_hold;   /* whether (3) holds at the end of every step */
    int has_rows;           /* whether memory->C is that of the step's beginning */
    zd_crossing_memory *memory;     /* NULL until it is needed; for few rows it is there from the start */
} zd_crossing;

zd_crossing zd_crossing_take(zd_arena *arena, zd_motion *motion, const zd_last *last);
int zd_crossing_begin(zd_crossing *self);       /* keeps where the motion is */
/* Keeps where a step of size h has led, by so much in natural units, squared; ZD_BIFURCATION_PASSED if a bifurcation lies in between. */
int zd_crossing_step(zd_crossing *self, double h, double moved);
/* memory->C, for which the point does not move; ZD_NO_MEMORY if there is none for it. */
int zd_crossing_need_rows(zd_crossing *self);
/* Whether the point is at a bifurcation. */
int zd_crossing_is_at_one(const zd_point *point);
/* det(C1 W C0^T), of the rows that count at the point, C0 being those where the step began. Its sign changes where a bifurcation is
 * passed. */
double zd_crossing_orientation(const zd_crossing *self);

#endif
