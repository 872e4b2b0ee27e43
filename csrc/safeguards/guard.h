/* Whether a step has led where its velocities lead, and is short enough for the method. */
#ifndef ZD_GUARD_H
#define ZD_GUARD_H

#include "../linalg/small.h"
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
    double fastest;         /* the largest |pdot|^2 at the end of a step that was looked at, in natural units */
    double reach;           /* |p1 - p0|^2 of the longest step that a glance is enough for, likewise; 0 until the first look */
    int64_t pause, next_look;   /* one of so many steps is looked at, the next being this one */
    int is_ample;           /* whether the step looked at last was far from too long */
    int streak;             /* steps in succession that were longer than the method is stable for */
    double largest_fourth;  /* the largest (omega h)^4 of all steps */
    double kinetic;         /* J: the largest kinetic energy of all steps */
} zd_guard;

typedef struct zd_detour {  /* sums of squares, in natural units */
    double moved, detour;
    double speed0, speed;   /* of pdot, where the step began and where it ended */
} zd_detour;

/* `stability`: the largest omega h at which the method is stable; 0: there is none. */
zd_guard zd_guard_take(zd_arena *arena, zd_motion *motion, const zd_settings *settings, double stability, const zd_last *last,
                       zd_crossing *crossing);
/* Keeps where the motion is; `step` is the one that begins there. */
int zd_guard_begin(zd_guard *guard, int64_t step);
/* Compares where a step of size h has led with where its velocities lead; ZD_BRANCH if these differ. */
int zd_guard_compare(zd_guard *guard, double h, int64_t next_step, zd_detour *found);
/* Whether the step, in which so much was found, is longer than the method is stable for; and how fast it is. */
int zd_guard_watch(zd_guard *guard, const zd_detour *found, double h);
/* When to look again after this step, in which all else was far from its limits, or not. */
void zd_guard_pause(zd_guard *guard, int64_t step, int is_ample);
/* Keeps the end of the step as the beginning of the next, */
void zd_guard_keep(zd_guard *guard, int64_t next_step);
/* or no more than what changes where that is looked at. */
void zd_guard_watch_next(zd_guard *guard);
double zd_guard_omega_h(const zd_guard *guard);     /* the largest seen */
double zd_guard_speed(const zd_guard *guard);       /* |pdot| where the step began, in natural units */

/* ---- what a step is told by ---- */

#define ZD_LONG 0.25    /* in natural units: a longer step may turn a row of C noticeably */
#define ZD_CALM 48.0    /* |p1 - p0| over the left side of guard.c: beyond, omega h is below a half */
#define ZD_FASTER 1.5   /* |pdot|^2 over the largest at a look: below, nothing has changed much */

ZD_INLINE zd_detour zd_guard_find(const int n, const zd_guard *guard, const double *p0, const double *p, double h, const double *inverse_unit)
{
    zd_detour sum = {0, 0, 0, 0};
    for (int i = 0; i < n; i++) {
        double moved = (p[i] - p0[i]) * inverse_unit[i], rate0 = guard->pdot[i] * inverse_unit[i], rate = guard->rate[i] * inverse_unit[i];
        double detour = moved - 0.5 * h * (rate0 + rate);
        sum.moved += moved * moved;
        sum.detour += detour * detour;
        sum.speed0 += rate0 * rate0;
        sum.speed += rate * rate;
    }
    return sum;
}

/* The bound of the detour's square */
ZD_INLINE double zd_guard_allows(const zd_guard *guard, double h, const zd_detour *found)
{
    return guard->astray * h * h * (found->speed0 + found->speed) + guard->nearby;
}

/* Whether the step shows nothing that a closer look should be made for. */
ZD_INLINE int zd_guard_is_calm(const zd_guard *guard, const zd_detour *found)
{
    return ZD_CALM * ZD_CALM * found->detour <= found->moved + guard->nearby && found->speed <= ZD_FASTER * guard->fastest + guard->nearby;
}

#endif
