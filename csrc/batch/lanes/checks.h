/* Full checks in lanes, as often as in a single run: resolution of each velocity, as in resolution.c, and distance from the stability
 * limit, as in guard.c. Products are not contracted here, so that counts are those of a single run.
 */
#include "steps.h"

/* Error of coordinate i in the step, in its own unit. */
ZD_KERNEL zd_real missed(const zd_lanes *self, int i, zd_real h)
{
    const zd_real before = REAL(self->k)[self->nq + i], after = REAL(self->vdot)[i];
    const zd_real v0 = REAL(self->y0)[self->nq + i], v1 = REAL(self->y)[self->nq + i];
    if (!self->has_A) return REAL(self->y)[i] - REAL(self->y0)[i] - h / 2 * (v0 + v1) + h * h / 12 * (after - before);
    return self->order_of_method < 2   ? h * h * after
           : self->order_of_method < 4 ? h * h * (after - before)
                                       : h * (v1 - v0 - h / 2 * (before + after));
}

/* Records a significant error of coordinate i. */
ZD_KERNEL void note_part(zd_lanes *self, int i, zd_condition counts, zd_real error)
{
    const zd_condition is_unresolved = counts & (error > ZD_UNRESOLVED_ERROR), is_first = is_unresolved & (*REAL(self->unresolved) == 0.0);
    *REAL(self->unresolved_time) = ZD_WHERE(is_first, *REAL(self->t), *REAL(self->unresolved_time));
    *REAL(self->unresolved) += AS_NUMBER(is_unresolved);
    const zd_condition is_largest = counts & (error > *REAL(self->part_error));
    *REAL(self->part_error) = ZD_WHERE(is_largest, error, *REAL(self->part_error));
    *REAL(self->part) = ZD_WHERE(is_largest, (double)i, *REAL(self->part));
}

/* True if an error is significant relative to `share` of the bounds. */
ZD_KERNEL zd_condition is_significant(zd_real error, zd_real path, double share)
{
    return (error > share * ZD_NOTED_ERROR) & (error > share * ZD_ERROR_SHARE * path);
}

/* Accumulates error and path of coordinate i in the lanes checked; returns whether the error is well below the significant ones. */
ZD_KERNEL zd_condition add_up(zd_lanes *self, int i, zd_condition checks, zd_real h, zd_real steps)
{
    const zd_real decay = ZD_WHERE(steps > 8.0, steps / 8 * ZD_DECAY, ZD_DECAY), unit = REAL(self->inverse_unit)[i];
    const zd_condition first = *REAL(self->last_checked) == 0.0;
    const zd_real led = steps * h / 2 * (REAL(self->y0)[self->nq + i] + REAL(self->y)[self->nq + i]) * unit;
    const zd_real at = self->has_A ? REAL(self->place)[i] + led : REAL(self->y)[i] * unit;
    zd_stored *all_errors = REAL(self->error) + i, *all_paths = REAL(self->path) + i;
    zd_stored *lowest = REAL(self->lowest) + i, *highest = REAL(self->highest) + i;
    const zd_real error =
        *all_errors + (steps * self->weight * size_of(missed(self, i, h)) * unit - decay * *all_errors);
    const zd_real path = *all_paths + (size_of(led) - decay * *all_paths);
    const zd_real low = ZD_WHERE(first | (at < *lowest), at, *lowest), high = ZD_WHERE(first | (at > *highest), at, *highest);
    *all_errors = ZD_WHERE(checks, error, *all_errors);
    *all_paths = ZD_WHERE(checks, path, *all_paths);
    *lowest = ZD_WHERE(checks, low, *lowest);
    *highest = ZD_WHERE(checks, high, *highest);
    if (self->has_A) REAL(self->place)[i] = ZD_WHERE(checks, at, REAL(self->place)[i]);
    const zd_real range = high - low, bounded = SMALLER(error, range);
    const zd_condition counts = checks & is_significant(bounded, path, 1);
    if (ZD_ANY(counts)) note_part(self, i, counts, bounded);
    return ~is_significant(error, path, ZD_AMPLE_RESOLUTION);
}

/* True if the step was well below the stability limit, by (omega h)^4 as in guard.c. */
ZD_KERNEL zd_condition is_ample(const zd_lanes *self, zd_real h)
{
    const zd_real square = h * h;
    zd_real changed = ZD_SPLAT(0.0), moved = changed;
    for (int i = 0; i < self->nv; i++) {
        const zd_real x = (REAL(self->vdot)[i] - REAL(self->k)[self->nq + i]) * REAL(self->inverse_unit)[i];
        changed += x * x;
    }
    for (int i = 0; i < self->nq; i++) {
        const zd_real x = (REAL(self->y)[i] - REAL(self->y0)[i]) * REAL(self->inverse_unit_p)[i];
        moved += x * x;
    }
    return square * square * changed <= ZD_AMPLE_STABILITY * self->limit * moved;
}

/* Sets the step of the next check in the lanes checked. */
ZD_KERNEL void pause(zd_lanes *self, zd_condition checks, zd_condition ample)
{
    const zd_real magic = ZD_SPLAT(0x1p52), number = *REAL(self->number);
    zd_real pause = ZD_WHERE(HOLDS(self->check_soon) | ~ample, (double)ZD_CHECK_EVERY, *REAL(self->check_pause));
    /* a pause is no longer than 64 steps, a power of two */
    const zd_real part = number / pause, whole = (part - 63.0 / 128 + magic) - magic;
    const zd_condition grows = ample & (pause < (double)ZD_CHECK_SELDOM) & (part == whole);
    pause = ZD_WHERE(grows, 2.0 * pause, pause);
    const zd_real pauses = (number / pause - 63.0 / 128 + magic) - magic;
    const zd_real next = ZD_WHERE(number < (double)ZD_CHECK_EVERY, 2.0 * number, (pauses + 1.0) * pause);
    *REAL(self->check_pause) = ZD_WHERE(checks, pause, *REAL(self->check_pause));
    *REAL(self->next_check) = ZD_WHERE(checks, next, *REAL(self->next_check));
    *REAL(self->check_soon) = ZD_WHERE(checks, 0.0, *REAL(self->check_soon));
}

/* Checks the last step in lanes with is_wanted. */
ZD_KERNEL void check(zd_lanes *self)
{
    const zd_condition checks = HOLDS(self->is_wanted);
    zd_condition ample = checks;
    const zd_real speed = *REAL(self->speed), fastest = *REAL(self->fastest);
    *REAL(self->fastest) = ZD_WHERE(checks & (speed > fastest), speed, fastest);
    if (self->is_fixed) {
        const zd_real h = *REAL(self->t) - *REAL(self->t_before), steps = *REAL(self->number) - *REAL(self->last_checked);
        for (int i = 0; i < self->nv; i++) ample &= add_up(self, i, checks, h, steps);
        ample &= is_ample(self, h);
        *REAL(self->last_checked) = ZD_WHERE(checks, *REAL(self->number), *REAL(self->last_checked));
    }
    pause(self, checks, ample);
}
