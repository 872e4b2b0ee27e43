#include "fixed.h"

#include "../linalg/small.h"
#include "clock.h"
#include "passage.h"
#include "road.h"
#include "short_step.h"
#include "variables.h"

enum { MOST_PARTS = 8 };    /* of a step that cannot be corrected */

static int integrate_and_land(zd_course *course, double h, double t1)
{
    const int is_short = zd_is_short(course->motion);
    int status = is_short ? zd_short_integrate(course, h) : zd_stepper_integrate(course->stepper, h);
    return status ? status : is_short ? zd_short_land(course, t1) : zd_passage_land(course, t1);
}

static int make_step(zd_course *course, double h, double t1)
{
    int status = integrate_and_land(course, h, t1);
    if (zd_road_is_left(course, status)) {
        status = zd_road_leave(course);
        if (!status) status = integrate_and_land(course, h, t1);
    }
    if (!zd_variables_lose_digits(course->stepper, status)) return status;
    status = zd_course_use_dependent(course);
    return status ? status : integrate_and_land(course, h, t1);
}

/* From where the step began to t1, in equal parts. */
static int take_parts(zd_course *course, double t1)
{
    const double t0 = course->undivided->t;
    int status = zd_stepper_return_to(course->stepper, course->undivided);
    if (!status) status = zd_safeguards_begin(course->safeguards, course->step + 1);
    for (int part = 1; !status && part <= course->parts; part++) {
        double t = part == course->parts ? t1 : t0 + (t1 - t0) * part / course->parts;
        status = make_step(course, t - course->stepper->t, t);
    }
    return status;
}

static void *take_place(zd_arena *arena, const void *of)
{
    const zd_place place = zd_place_take(arena, of);
    return zd_take_filled(arena, &place, sizeof place);
}

static int remember_undivided(zd_course *course)
{
    zd_motion *motion = course->motion;
    const zd_last *last = &course->stepper->last;
    const int own = motion->formulation_size;
    if (!course->undivided) course->undivided = zd_store_take(&motion->store, take_place, motion);
    zd_place *undivided = course->undivided;
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

static int divide_step(zd_course *course, int status, double t1)
{
    if (remember_undivided(course)) return ZD_NO_MEMORY;
    for (course->parts = 2; is_too_far(status) && course->parts <= MOST_PARTS; course->parts *= 2) {
        int again = take_parts(course, t1);
        if (!again) {
            course->parts = 0;
            course->motion->statistics.subdivided++;
            return ZD_DONE;
        }
        status = again;
    }
    return status;
}

int zd_fixed_step(zd_course *course)
{
    const zd_settings *settings = course->settings;
    double t1 = zd_time_of_step(settings->t0, settings->step, course->step, course->steps, course->end);
    int status = make_step(course, course->step == course->steps ? t1 - course->stepper->t : settings->step, t1);
    return is_too_far(status) ? divide_step(course, status, t1) : status;
}
