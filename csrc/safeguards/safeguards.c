#include "safeguards.h"

void zd_safeguards_take(zd_safeguards *self, zd_arena *arena, zd_motion *motion, const zd_settings *settings, double stability,
                        const zd_last *last)
{
    self->guard = zd_guard_take(arena, motion, settings, stability, last);
    self->crossing = zd_crossing_take(arena, motion, last);
    self->crossing.rate0 = self->guard.pdot;
    self->crossing.rate1 = self->guard.rate;
    self->crossing.constraints_hold = self->guard.checks_branch;
}

int zd_safeguards_begin(zd_safeguards *self, long step)
{
    int status = zd_guard_begin(&self->guard, step);
    return status ? status : zd_crossing_begin(&self->crossing);
}

int zd_safeguards_judge(zd_safeguards *self, double h, long next_step, int is_part)
{
    zd_detour found;
    if (!self->guard.has_begun) return ZD_DONE;
    int status = zd_guard_compare(&self->guard, h, next_step, &found);
    if (!status) status = zd_crossing_step(&self->crossing, h, found.moved);
    if (status) return status;
    zd_guard_keep(&self->guard, &found, h, next_step, is_part);
    return ZD_DONE;
}
