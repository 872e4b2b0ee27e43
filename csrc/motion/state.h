/* States of a motion that can be restored. */
#ifndef ZD_STATE_H
#define ZD_STATE_H

typedef struct zd_state {
    double t;
    double *p, *v;          /* (nq,), (nv,) */
    double *extra;          /* entries of the integrated state that follow the formulation's */
} zd_state;

/* Acceleration at a zd_state, restored with it so that a step from there needs no evaluation. */
typedef struct zd_cached_accelerations {
    double *vdot, *lambda;  /* (nv,), (m,) */
    double *pivots;         /* (nv,): of the closed-form path; NULL if the system has no closed form */
    const void *order;      /* elimination order of these pivots; NULL: none */
    double smallest;        /* smallest of them, as zd_path has it */
    int are_known;          /* true if the fields above are set */
} zd_cached_accelerations;

typedef struct zd_last {    /* the current step: its size, and the state at its start */
    double t, h;
    double *y, *p, *v;      /* (size,), (nq,), (nv,) */
    void *chosen;           /* copy of the formulation's choice of variables at the start; NULL: no copy is made */
} zd_last;

#endif
