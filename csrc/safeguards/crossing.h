/* Detection of bifurcations inside a step. */
#ifndef ZD_CROSSING_H
#define ZD_CROSSING_H

#include "../motion/motion.h"
#include "../motion/state.h"

/* Memory for comparing C along a step. */
typedef struct zd_crossing_memory {
    double *C;              /* C at the start of the step, stored as the point's C, times the squares of the characteristic scales */
    double *previous;       /* likewise, at the previous intermediate point */
    double *p, *p1, *v1;    /* (nq,), (nq,), (nv,): intermediate point; end of the step */
    double *turn;           /* (m, m): C1 W C0^T, factored */
    int *order;             /* (m,) pivots of its factors */
    double *scratch;        /* scratch memory of the system for these evaluations */
} zd_crossing_memory;

typedef struct zd_crossing {
    zd_motion *motion;
    const zd_last *last;    /* the step */
    const double *rate0, *rate1;    /* (nq,): pdot at its ends */
    int has_begun;          /* true if a start is saved for comparison: false at a bifurcation */
    int may_pass;           /* true if the step may pass a bifurcation */
    int constraints_hold;   /* true if (3) is satisfied at the end of every step */
    int has_rows;           /* true if memory->C belongs to the start of the step */
    zd_crossing_memory *memory;     /* NULL until it is needed; with few constraints it is allocated at creation */
} zd_crossing;

zd_crossing zd_crossing_create(zd_arena *arena, zd_motion *motion, const zd_last *last);
int zd_crossing_begin(zd_crossing *self);       /* saves the present point as the start of a step */
/* Checks a step of size h and saves its end as the start of the next; ZD_BIFURCATION_PASSED if a bifurcation lies inside. `moved` is its
 * squared displacement in characteristic scales. */
int zd_crossing_step(zd_crossing *self, double h, double moved);
/* Evaluates memory->C without changing the point; ZD_NO_MEMORY if memory is lacking. */
int zd_crossing_need_rows(zd_crossing *self);
/* True if the point is at a bifurcation. */
int zd_crossing_is_at_one(const zd_point *point);
/* det(C1 W C0^T), of the independent constraints at the point (C1) and at the start of the step (C0). Its sign changes where a bifurcation
 * is passed. */
double zd_crossing_orientation(const zd_crossing *self);

#endif
