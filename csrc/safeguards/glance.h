/* Quick check of a step on the closed-form path. It passes nearly all steps, and only those that the full checks of guard.c and
 * paths/choose.c would pass without saving anything. Executed in every step, it takes fewer instructions by sufficient conditions: if
 * the detour is at most 1 / ZD_CALM_DETOUR of the displacement, it satisfies the bound by the velocities at both ends, too; and pivots of one
 * sign within a factor of four of one number have neither changed sign nor shrunk by more than 16. */
#ifndef ZD_GLANCE_H
#define ZD_GLANCE_H

#include "../motion/pivots.h"
#include "safeguards.h"

/* Displacement and detour (p1 - p0 - h (v0 + v1) / 2) of a step: sums of squares in characteristic scales. Below, `half` is h / 2. */
typedef struct zd_seen {
    double moved, detour;
} zd_seen;

ZD_INLINE void zd_see_one(zd_seen *seen, int i, double half, const double *p0, const double *v0, const double *p, const double *v,
                          const double *inverse_unit)
{
    const double path = p[i] - p0[i], missed = path - half * (v0[i] + v[i]);
    seen->moved += (path * inverse_unit[i]) * (path * inverse_unit[i]);
    seen->detour += (missed * inverse_unit[i]) * (missed * inverse_unit[i]);
}

/* Sums over n coordinates with pdot = v, from (p0, v0) to (p, v), two at a time in vectors. */
ZD_INLINE zd_seen zd_see(const int n, double half, const double *p0, const double *v0, const double *p, const double *v,
                         const double *inverse_unit)
{
    zd_seen seen = {0, 0};
#ifdef ZD_HAS_VECTORS
#define ZD_TWO(x) (*(const zd_stored_two *)((x) + i))
    const zd_two halves = {half, half};
    zd_two moved = {0, 0}, detour = {0, 0};
    for (int i = 0; i + 1 < n; i += 2) {
        const zd_two path = ZD_TWO(p) - ZD_TWO(p0), missed = path - halves * (ZD_TWO(v0) + ZD_TWO(v));
        const zd_two a = path * ZD_TWO(inverse_unit), b = missed * ZD_TWO(inverse_unit);
        moved = i ? moved + a * a : a * a;
        detour = i ? detour + b * b : b * b;
    }
#undef ZD_TWO
    if (n > 1) seen = (zd_seen){moved[0] + moved[1], detour[0] + detour[1]};
    if (n % 2) zd_see_one(&seen, n - 1, half, p0, v0, p, v, inverse_unit);
#else
    for (int i = 0; i < n; i++) zd_see_one(&seen, i, half, p0, v0, p, v, inverse_unit);
#endif
    return seen;
}

/* True if the step to (p, v) passes, with n coordinates and pdot = v. NaN and infinity fail each comparison. */
ZD_INLINE int zd_safeguards_glance(const int n, zd_safeguards *self, double h, int64_t next_step, const double *p, const double *v)
{
    zd_guard *guard = &self->guard;
    const zd_last *last = guard->last;
    if (guard->watches_step) return 0;
    const zd_seen seen = zd_see(n, 0.5 * h, last->p, last->v, p, v, guard->motion->point->inverse_unit_p);
    if (!(ZD_CALM_DETOUR * ZD_CALM_DETOUR * seen.detour <= seen.moved + guard->nearby) || !(seen.moved <= guard->reach)) return 0;
    if (!zd_pivots_stay(&guard->motion->path)) return 0;
    if (next_step >= guard->next_look) zd_guard_watch_next(guard);
    return 1;
}

#endif
