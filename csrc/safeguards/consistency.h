/* Consistency of a system during a run: symmetry of M, and Jacobians against differences of Phi. */
#ifndef ZD_CONSISTENCY_H
#define ZD_CONSISTENCY_H

#include "../motion/motion.h"

typedef struct zd_consistency {
    zd_motion *motion;
    int compares;           /* true if C and Phi_t are hand-written and checked; otherwise no memory is allocated */
    double slowest;         /* 1/s: lower bound of the rates, one characteristic scale over the whole run */
    double of_time;         /* s: characteristic scale of time, from zd_consistency_jacobian() */
    double *direction;      /* (nv + 1,): w, s */
    double *pdot, *p;       /* (nq,): A w; displaced coordinates */
    double *Phi, *quotient, *central;   /* (mh,): displaced Phi; difference quotients; the central one */
    double *scratch;        /* scratch memory of the system for displaced evaluations */
    int row, column;        /* the wrong entry of C; column nv is Phi_t */
    double given, found;    /* its given value, and its value by differences */
} zd_consistency;

zd_consistency zd_consistency_create(zd_arena *arena, zd_motion *motion, const zd_settings *settings);
int zd_consistency_mass(zd_point *point);           /* checks that M, already evaluated, is symmetric; else ZD_NOT_SYMMETRIC */
/* Checks hand-written C and Phi_t against differences of Phi, in a direction that depends on the step; else ZD_NOT_JACOBIAN. */
int zd_consistency_jacobian(zd_consistency *self, int64_t step);
int zd_consistency_check(zd_consistency *self, int64_t step);   /* both checks, the second at its intervals */

#endif
