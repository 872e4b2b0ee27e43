/* Newton's iteration for the stages of a step of radau.c, with its tests of convergence. */
#ifndef ZD_RADAU_NEWTON_H
#define ZD_RADAU_NEWTON_H

#include "factors.h"
#include "stages.h"

typedef struct zd_radau_newton {
    int size;               /* entries of the state */
    const zd_rate *rate;
    const double *y0;       /* (size,): state at the start of the step */
    double t0, h;           /* s: time there, and size of the step */
    double *z, *w;          /* (stages, size): stages minus y0; T^-1 z */
    double *f;              /* (stages, size): rates at the stages */
    double *change;         /* (stages, size): change of w by an iteration */
    double *other;          /* (stages, size): the same for stages disturbed in their last bit */
    double *stage;          /* (size,): one stage */
    double *scale;          /* (size,): error scale of the step */
    int has_scale;          /* true if `scale` is set; otherwise the step is solved to rounding */
    zd_radau_matrices matrices;
    zd_radau_stages stages;
    int by_stages;          /* true if each stage has its own J */
    double *seen;           /* (size,): largest size of each entry so far; scale of the differences */
    double contraction;     /* ratio of the last change to the one before */
    double norm_before;     /* norm of the previous change in this step; 0: none */
    int iterations;
} zd_radau_newton;

zd_radau_newton zd_radau_newton_create(zd_arena *arena, int size);
/* Solves for z, from its estimate, with matrices factored for this step. ZD_NO_CONVERGENCE, ZD_NOT_FINITE, or the status of the rate */
int zd_radau_newton_iterate(zd_radau_newton *self, zd_statistics *statistics);

#endif
