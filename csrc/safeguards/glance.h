/* What a step is compared by, and whether a step on the direct road needs no more than a glance, as nearly all do: then nothing of guard.c and
 * motion/direct.c would find anything in it, and all that these would keep is kept. */
#ifndef ZD_GLANCE_H
#define ZD_GLANCE_H

#include "../motion/pivots.h"
#include "safeguards.h"

/* Of n coordinates whose rates are the velocities. What is not a number or infinite is passed by no comparison. */
ZD_INLINE int zd_safeguards_glance(const int n, zd_safeguards *self, double h, int64_t next_step)
{
    zd_guard *guard = &self->guard;
    const zd_point *point = guard->motion->point;
    const zd_detour found = zd_guard_find(n, guard, guard->last->p, point->p, h, point->inverse_unit_p);
    if (next_step >= guard->next_look || !guard->has_begun) return 0;
    if (!(found.detour <= zd_guard_allows(guard, h, &found)) || !(found.moved <= ZD_LONG * ZD_LONG)) return 0;
    if (!zd_guard_is_calm(guard, &found) || !zd_pivots_stay(n, &guard->motion->road)) return 0;
    guard->speed = found.speed;
    return 1;
}

#endif
