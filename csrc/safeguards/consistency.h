/* Whether a system stays what it says it is. */
#ifndef ZD_CONSISTENCY_H
#define ZD_CONSISTENCY_H

#include "../motion/motion.h"

typedef struct zd_consistency {
    zd_motion *motion;
    int compares;           /* whether derivatives of Phi are compared with those that are given; else there is no memory for it */
    double slowest;         /* 1/s: of the rates, in natural units, that count: one unit over the whole run */
    double of_time;         /* what goes with a step of one in the direction of time, see consistency.c */
    double *direction;      /* (nv + 1,): w, s */
    double *pdot, *p;       /* (nq,): A w; displaced */
    double *Phi, *quotient, *central;   /* (mh,) */
    double *scratch;        /* the system's own */
    int row, column;        /* the entry that is wrong; column nv is Phi_t */
    double given, found;    /* its two values */
} zd_consistency;

zd_consistency zd_consistency_take(zd_arena *arena, zd_motion *motion, const zd_settings *settings);
int zd_consistency_mass(zd_point *point);           /* whether M is symmetric; it is known there */
/* Whether C and Phi_t are the derivatives of Phi, where they are compared; in another direction at every step. */
int zd_consistency_jacobian(zd_consistency *self, int64_t step);
int zd_consistency_look(zd_consistency *self, int64_t step);   /* both, where it is due */

#endif
