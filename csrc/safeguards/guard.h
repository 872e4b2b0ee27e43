/* Whether a step has led where its velocities lead, and is short enough for the method. */
#ifndef ZD_GUARD_H
#define ZD_GUARD_H

#include "../motion/motion.h"
#include "../motion/place.h"

typedef struct zd_guard {   /* where a step began, with which its end is compared */
    zd_motion *motion;
    const zd_last *last;    /* the step */
    int kept;               /* whether there is such */
    int branch, stability;  /* what is looked at */
    int looking;            /* whether at the stability of the next step */
    double astray, nearby, limit;   /* bounds of these, to the powers that are compared */
    double *pdot, *vdot;    /* (nq,), (nv,): there; p and v are those of `last` */
    double *rate;           /* (nq,): pdot at the end */
    double *p, *v, *C;      /* (nq,), (nv,), (mh, nv): at the end, while the point is elsewhere */
    double speed;           /* |pdot|^2 there, in natural units */
    int streak;             /* steps in succession that were longer than the method is stable for */
    double fourth;          /* (omega h)^4, the largest seen */
    double kinetic;         /* energy, likewise */
} zd_guard;

typedef struct zd_detour {  /* sums of squares, in natural units */
    double moved, detour, speed;
} zd_detour;

/* `stability`: the largest omega h at which the method is stable; 0: there is none. */
zd_guard zd_guard_take(zd_arena *arena, zd_motion *motion, const zd_settings *settings, double stability, const zd_last *last);
/* Keeps where the motion is; `step` is the one that begins there. */
int zd_guard_begin(zd_guard *guard, long step);
/* Compares where a step of size h has led with where its velocities lead; ZD_BRANCH if these differ. */
int zd_guard_compare(zd_guard *guard, double h, long next_step, zd_detour *found);
/* Keeps the end of the step as the beginning of the next. Counts it if the step is longer than the method is stable for; but not the
 * part of one, which may be given up yet. */
void zd_guard_keep(zd_guard *guard, const zd_detour *found, double h, long next_step, int is_part);
double zd_guard_omega_h(const zd_guard *guard);     /* the largest seen */

#endif
