/* Breaks: a step ends shortly before one, and the next begins shortly after it with the same state, so that all stages of each are on one
 * side, however their times are rounded. Where a step begins follows from the time alone, for runs that continue and steps that are repeated.
 */
#include "step_loop.h"

#include <math.h>

#include "../step_limits.h"

/* The first time of a group after t */
static double next_of(const zd_break_group *group, double t)
{
    const double first = group->t[0], turns = group->period > 0 ? floor((t - first) / group->period) : 0, shift = turns * group->period;
    int low = 0, high = group->count;
    while (low < high) {
        const int middle = low + (high - low) / 2;
        if (group->t[middle] + shift > t) high = middle;
        else low = middle + 1;
    }
    return low < group->count ? group->t[low] + shift : group->period > 0 ? first + (turns + 1) * group->period : INFINITY;
}

static double next_break(const zd_breaks *breaks, double t)
{
    double next = INFINITY;
    for (int i = 0; i < breaks->groups; i++) next = fmin(next, next_of(&breaks->group[i], t));
    return next;
}

/* s: distance from a break at which times are on one of its sides */
static double rounding_at(const zd_step_loop *loop, double t)
{
    const zd_settings *settings = loop->settings;
    const double largest = fmax(fabs(settings->t0), fmax(fabs(loop->stepper->t), settings->is_open ? 0 : fabs(settings->t1)));
    return ZD_TIME_RESOLUTION * (isfinite(t) ? fmax(largest, fabs(t)) : largest);
}

/* A speed that has jumped with its law: velocities are projected, and the change of their energy is the work of its drive, not an error. */
static int project(zd_step_loop *loop)
{
    zd_motion *motion = loop->motion;
    double before, after = 0;
    if (!zd_constraints(motion->point->system)) return ZD_DONE;
    int status = zd_motion_balance(motion, &before);
    if (!status) status = zd_path_end(loop->stepper, loop->stepper->t, 0);
    if (!status) status = zd_motion_balance(motion, &after);
    if (status || !(fabs(after - before) > ZD_ENERGY_ROUNDING * zd_point_kinetic(motion->point))) return status;
    zd_motion_add_jump(motion, loop->stepper->t, after - before);
    return ZD_PAUSED;
}

int zd_pass_break(zd_step_loop *loop)
{
    const zd_breaks *breaks = loop->motion->system.breaks;
    zd_stepper *stepper = loop->stepper;
    if (!breaks || !zd_is_adaptive(loop)) return ZD_DONE;
    const double t = stepper->t, here = next_break(breaks, t - 2 * rounding_at(loop, t)), rounding = rounding_at(loop, here);
    if (here - t <= 2 * rounding && t < here + rounding) stepper->t = fmin(here + rounding, loop->end);
    const double next = next_break(breaks, stepper->t + 4 * rounding_at(loop, stepper->t));
    loop->before_break = next - rounding_at(loop, next);
    if (stepper->t == t) return ZD_DONE;
    zd_point *point = loop->motion->point;
    point->t = stepper->t;
    point->known &= point->constant;
    const int status = project(loop), renewed = status < 0 ? status : zd_renew(loop);
    return renewed ? renewed : status;
}
