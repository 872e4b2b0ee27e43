/* Where a motion was, to be returned to. */
#ifndef ZD_PLACE_H
#define ZD_PLACE_H

typedef struct zd_place {
    double t;
    double *p, *v;          /* (nq,), (nv,) */
    double *extra;          /* what the state has besides them */
} zd_place;

typedef struct zd_last {    /* the step being made: its size, and where it began */
    double t, h;
    double *y, *p, *v;      /* (size,), (nq,), (nv,) */
} zd_last;

#endif
