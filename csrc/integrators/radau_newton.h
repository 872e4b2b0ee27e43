/* Newton's iteration for the stages of a step of radau.c: what it works on, when it has ended, and when it does not lead anywhere. */
#ifndef ZD_RADAU_NEWTON_H
#define ZD_RADAU_NEWTON_H

#include "radau_factors.h"
#include "radau_stages.h"

typedef struct zd_radau_newton {
    int size;               /* of the state */
    const zd_rate *rate;
    const double *y0;       /* where the step begins, */
    double t0, h;           /* when, and how long it is */
    double *z, *w;          /* (stages, size): of the stages, less y0; and T^-1 z */
    double *f;              /* (stages, size): their rates */
    double *change;         /* (stages, size): of w, by an iteration; */
    double *other;          /* the same, of stages that are disturbed in their last bit */
    double *stage;          /* (size,) */
    double *scale;          /* (size,): what the error of the step is measured by; */
    int has_scale;          /* whether that is known: else the step is solved to rounding */
    zd_radau_matrices matrices;
    zd_radau_stages stages;
    int by_stages;          /* whether each stage has a J of its own */
    double *seen;           /* (size,): the largest that entries of the state have been, by which differences are made */
    double contraction;     /* what the last iteration left of the change before */
    double norm_before;     /* of the iteration before, in this step; 0: there was none */
    int iterations;
} zd_radau_newton;

zd_radau_newton zd_radau_newton_take(zd_arena *arena, int size);
/* z from an estimate of it, with matrices that are factored for the step. ZD_NO_CONVERGENCE, ZD_NOT_FINITE, or what the rate returned */
int zd_radau_newton_iterate(zd_radau_newton *self, zd_statistics *statistics);

#endif
