/* Acceptance of a step: its displacement must agree with its velocities, and its size must be within the method's stability. */
#ifndef ZD_GUARD_H
#define ZD_GUARD_H

#include "../linalg/small.h"
#include "../step_limits.h"
#include "crossing.h"

/* The start of a step, with which its end is compared, and the schedule of checks. */
typedef struct zd_guard {
    zd_motion *motion;
    const zd_last *last;    /* the step */
    zd_crossing *crossing;  /* provides C at the start of the step */
    int has_begun;          /* true if a start is saved for comparison */
    int checks_branch, checks_stability;    /* true for each of the two comparisons that is made */
    int watches_step;       /* true if this step gets the full checks */
    double astray, nearby, limit;   /* bounds: ASTRAY^2 / 2, NEARBY^2, (largest omega h)^4 of guard.c */
    double *pdot, *vdot;    /* (nq,), (nv,): at the start of the step; p and v are those of `last` */
    double *rate;           /* (nq,): pdot at the end */
    double fastest;         /* largest |pdot|^2 at the end of a checked step, in characteristic scales */
    double reach;           /* largest |p1 - p0|^2 for which the quick check suffices, likewise; 0 until the first full check */
    int64_t pause, next_check;   /* steps between full checks; the step of the next one */
    int is_ample;           /* true if the last checked step was far below the stability limit */
    int streak;             /* consecutive steps longer than the method is stable for */
    double largest_fourth;  /* largest (omega h)^4 of all checked steps */
    double kinetic;         /* J: largest kinetic energy of all checked steps */
} zd_guard;

typedef struct zd_detour {  /* sums of squares, in characteristic scales */
    double moved, detour;   /* displacement p1 - p0; detour p1 - p0 - h (pdot0 + pdot1) / 2 */
    double speed0, speed;   /* pdot at the start; at the end */
} zd_detour;

/* `stability`: largest omega h at which the method is stable; 0: unbounded. */
zd_guard zd_guard_create(zd_arena *arena, zd_motion *motion, const zd_settings *settings, double stability, const zd_last *last,
                       zd_crossing *crossing);
/* Saves the present point as the start of the step with this number. */
int zd_guard_begin(zd_guard *guard, int64_t step);
/* Compares displacement and velocities of a step of size h; ZD_BRANCH if they disagree. */
int zd_guard_compare(zd_guard *guard, double h, int64_t next_step, zd_detour *found);
/* Updates omega h, the count of too long steps, the largest speed and energy, from a step that gets the full checks. */
int zd_guard_watch(zd_guard *guard, const zd_detour *found, double h);
/* Schedules the next full check; `is_ample`: all other checked quantities were far from their limits. */
void zd_guard_pause(zd_guard *guard, int64_t step, int is_ample);
/* Saves the end of the step as the start of the next, */
void zd_guard_save(zd_guard *guard, int64_t next_step);
/* or only the acceleration, if the next step gets the full checks. */
void zd_guard_watch_next(zd_guard *guard);
double zd_guard_omega_h(const zd_guard *guard);     /* largest omega h of all checked steps */
double zd_guard_speed(const zd_guard *guard);       /* |pdot| at the start of the step, in characteristic scales */

/* ---- detour of a step ---- */

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

/* Bound of the squared detour. */
ZD_INLINE double zd_guard_allows(const zd_guard *guard, double h, const zd_detour *found)
{
    return guard->astray * h * h * (found->speed0 + found->speed) + guard->nearby;
}

/* True if detour and speed give reason to keep the interval to the next full check. */
ZD_INLINE int zd_guard_is_calm(const zd_guard *guard, const zd_detour *found)
{
    return ZD_CALM_DETOUR * ZD_CALM_DETOUR * found->detour <= found->moved + guard->nearby &&
           found->speed <= ZD_FASTER_SPEED * guard->fastest + guard->nearby;
}

#endif
