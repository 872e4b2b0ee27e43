#include "safeguards.h"

void zd_safeguards_create(zd_safeguards *self, zd_arena *arena, zd_motion *motion, const zd_settings *settings, const zd_card *method,
                        const zd_last *last)
{
    self->guard = zd_guard_create(arena, motion, settings, method->stability, last, &self->crossing);
    self->crossing = zd_crossing_create(arena, motion, last);
    self->crossing.rate0 = self->guard.pdot;
    self->crossing.rate1 = self->guard.rate;
    self->crossing.constraints_hold = self->guard.checks_branch;
    const zd_guard *guard = &self->guard;
    if (settings->steps == ZD_FIXED_STEPS)
        self->resolution = zd_resolution_create(arena, motion, method->order, last, guard->vdot, guard->pdot, guard->rate);
    self->consistency = zd_consistency_create(arena, motion, settings);
}

int zd_safeguards_begin(zd_safeguards *self, int64_t step)
{
    int status = zd_guard_begin(&self->guard, step);
    return status ? status : zd_crossing_begin(&self->crossing);
}

/* Full checks, made at intervals: stability, energy, resolution of each coordinate, and consistency of the system. */
static int check_fully(zd_safeguards *self, const zd_detour *found, double h, int64_t step)
{
    int status = zd_guard_watch(&self->guard, found, h);
    if (!status && self->guard.checks_stability) status = zd_resolution_check(&self->resolution, h, step);
    zd_guard_pause(&self->guard, step, !self->guard.checks_stability || self->resolution.is_ample);
    return status ? status : zd_consistency_check(&self->consistency, step);
}

static int check_step(zd_safeguards *self, const zd_detour *found, double h, int64_t step, int parts)
{
    if (!parts) return check_fully(self, found, h, step);
    return self->guard.checks_stability ? zd_resolution_check_turns(&self->resolution, h, step, parts) : ZD_DONE;
}

int zd_safeguards_compare(zd_safeguards *self, double h, double moved)
{
    return zd_crossing_step(&self->crossing, h, moved);
}

int zd_safeguards_judge(zd_safeguards *self, zd_comparison *compare, double h, int64_t next_step, int parts)
{
    zd_detour found;
    if (!self->guard.has_begun) return ZD_DONE;
    int status = zd_guard_compare(&self->guard, h, next_step, &found);
    if (!status) status = compare(self, h, found.moved);
    if (status) return status;
    if (self->guard.watches_step) status = check_step(self, &found, h, next_step - 1, parts);
    zd_guard_save(&self->guard, next_step);
    return status;
}
