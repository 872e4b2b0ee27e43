/* Whether a step has led where its velocities lead, and is short enough for the method. */
#ifndef ZD_GUARD_H
#define ZD_GUARD_H

#include "crossing.h"

/* Where a step began, with which its end is compared. */
typedef struct zd_guard {
    zd_motion *motion;
    const zd_last *last;    /* the step */
    zd_crossing *crossing;  /* which knows C where the step began */
    int has_begun;          /* whether there is anything to compare with */
    int checks_branch, checks_stability;    /* which of the two comparisons are made */
    int watches_step;       /* whether the step is one that is looked at closely */
    double astray, nearby, limit;   /* bounds of these, to the powers that are compared */
    double *pdot, *vdot;    /* (nq,), (nv,): where the step began; p and v are those of `last` */
    double *rate;           /* (nq,): pdot at the end */
    double speed;           /* |pdot|^2 where the step began, in natural units */
    int streak;             /* steps in succession that were longer than the method is stable for */
    double largest_fourth;  /* the largest (omega h)^4 of all steps */
    double kinetic;         /* J: the largest kinetic energy of all steps */
} zd_guard;

typedef struct zd_detour {  /* sums of squares, in natural units */
    double moved, detour, speed;
} zd_detour;

/* `stability`: the largest omega h at which the method is stable; 0: there is none. */
zd_guard zd_guard_take(zd_arena *arena, zd_motion *motion, const zd_settings *settings, double stability, const zd_last *last,
                       zd_crossing *crossing);
/* Keeps where the motion is; `step` is the one that begins there. */
int zd_guard_begin(zd_guard *guard, int64_t step);
/* Compares where a step of size h has led with where its velocities lead; ZD_BRANCH if these differ. */
int zd_guard_compare(zd_guard *guard, double h, int64_t next_step, zd_detour *found);
/* Whether the step, in which the motion has moved by so much, is longer than the method is stable for; and how fast it is. */
int zd_guard_watch(zd_guard *guard, double moved, double h);
/* Keeps the end of the step as the beginning of the next. */
void zd_guard_keep(zd_guard *guard, double speed, int64_t next_step);
double zd_guard_omega_h(const zd_guard *guard);     /* the largest seen */

#endif
