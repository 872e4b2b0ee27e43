/* Where a motion was, to be returned to. */
#ifndef ZD_STATE_H
#define ZD_STATE_H

typedef struct zd_state {
    double t;
    double *p, *v;          /* (nq,), (nv,) */
    double *extra;          /* what the state has besides them */
} zd_state;

/* The acceleration where a motion was, with which a step may begin there: to be handed back with the place. */
typedef struct zd_cached_accelerations {
    double *vdot, *lambda;  /* (nv,), (m,) */
    double *pivots;         /* (nv,): of the direct road; NULL where the system brings none, */
    const void *order;      /* the order of elimination that they are of; NULL: none */
    double smallest;        /* and of them */
    int are_known;
} zd_cached_accelerations;

typedef struct zd_last {    /* the step being made: its size, and where it began */
    double t, h;
    double *y, *p, *v;      /* (size,), (nq,), (nv,) */
    void *chosen;           /* a copy of the formulation's choice of variables there; NULL: none is kept */
} zd_last;

#endif
