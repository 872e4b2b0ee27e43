#include "fixed.h"

#include "../linalg/small.h"
#include "clock.h"
#include "passage.h"
#include "path.h"
#include "short_step.h"
#include "variables.h"

enum { MOST_PARTS = 8 };    /* largest number of parts of a step that fails */

static int integrate_and_land(zd_step_loop *loop, double h, double t1)
{
    const int is_short = zd_is_short(loop->motion);
    int status = is_short ? zd_short_integrate(loop, h) : zd_stepper_integrate(loop->stepper, h);
    return status ? status : is_short ? zd_short_land(loop, t1) : zd_passage_land(loop, t1);
}

static int make_step(zd_step_loop *loop, double h, double t1)
{
    int status = integrate_and_land(loop, h, t1);
    if (zd_path_is_left(loop, status)) {
        status = zd_path_leave(loop);
        if (!status) status = integrate_and_land(loop, h, t1);
    }
    if (!zd_variables_lose_digits(loop->stepper, status)) return status;
    status = zd_step_loop_use_dependent(loop);
    return status ? status : integrate_and_land(loop, h, t1);
}

/* Repeats the step to t1 in equal parts. */
static int take_parts(zd_step_loop *loop, double t1)
{
    const double t0 = loop->undivided->t;
    int status = zd_stepper_return_to(loop->stepper, loop->undivided);
    if (!status) status = zd_safeguards_begin(loop->safeguards, loop->step + 1);
    for (int part = 1; !status && part <= loop->parts; part++) {
        double t = part == loop->parts ? t1 : t0 + (t1 - t0) * part / loop->parts;
        status = make_step(loop, t - loop->stepper->t, t);
    }
    return status;
}

static void *take_place(zd_arena *arena, const void *of)
{
    const zd_state place = zd_state_take(arena, of);
    return zd_take_filled(arena, &place, sizeof place);
}

static int remember_undivided(zd_step_loop *loop)
{
    zd_motion *motion = loop->motion;
    const zd_last *last = &loop->stepper->last;
    const int own = motion->formulation_size;
    if (!loop->undivided) loop->undivided = zd_store_take(&motion->store, take_place, motion);
    zd_state *undivided = loop->undivided;
    if (!undivided) return ZD_NO_MEMORY;
    undivided->t = last->t;
    zd_copy(motion->system.nq, last->p, undivided->p);
    zd_copy(motion->system.nv, last->v, undivided->v);
    zd_copy(motion->rate.size - own, last->y + own, undivided->extra);
    return ZD_DONE;
}

static int is_too_far(int status)
{
    return status == ZD_NO_CONVERGENCE || status == ZD_BRANCH || status == ZD_NO_EMBEDDING || status == ZD_BIFURCATION_PASSED;
}

static int divide_step(zd_step_loop *loop, int status, double t1)
{
    if (remember_undivided(loop)) return ZD_NO_MEMORY;
    for (loop->parts = 2; is_too_far(status) && loop->parts <= MOST_PARTS; loop->parts *= 2) {
        int again = take_parts(loop, t1);
        if (!again) {
            loop->parts = 0;
            loop->motion->statistics.subdivided++;
            return ZD_DONE;
        }
        status = again;
    }
    return status;
}

int zd_fixed_step(zd_step_loop *loop)
{
    const zd_settings *settings = loop->settings;
    double t1 = zd_time_of_step(settings->t0, settings->step, loop->step, loop->steps, loop->end);
    int status = make_step(loop, loop->step == loop->steps ? t1 - loop->stepper->t : settings->step, t1);
    return is_too_far(status) ? divide_step(loop, status, t1) : status;
}
