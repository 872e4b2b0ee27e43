/* Step across a bifurcation: bisection by shorter steps decides whether the motion passes through it continuously. */
#include "passage.h"

#include <math.h>

#include "../constraints/rows.h"
#include "../linalg/bracket.h"
#include "../step_limits.h"
#include "variables.h"

static const double SHORT = 0.25 * ZD_LIMITS_REGION;    /* in characteristic scales: displacements that only a jump exceeds */

static int finish_and_check(zd_step_loop *loop, double t1)
{
    zd_stepper *stepper = loop->stepper;
    double h = t1 - stepper->t;
    int status = zd_stepper_land(stepper, t1, loop->step, t1 == loop->end || loop->parts);
    return status ? status : zd_safeguards_judge(loop->safeguards, h, loop->step + 1, loop->parts);
}

static int integrate_and_finish(zd_step_loop *loop, double h, double t1)
{
    int status = zd_stepper_integrate(loop->stepper, h);
    return status ? status : finish_and_check(loop, t1);
}

/* Repeats the step to t, corrected but without acceptance checks. */
static int move(zd_stepper *stepper, double t)
{
    int status = zd_stepper_return(stepper);
    return status ? status : zd_stepper_make_substep(stepper, t);
}

/* Finds the bifurcation; found <- true if the motion is continuous where the sign of the orientation changes. */
static int find(zd_step_loop *loop, double t1, int *found)
{
    zd_stepper *stepper = loop->stepper;
    zd_point *point = loop->motion->point;
    const zd_safeguards *safeguards = loop->safeguards;
    double t0 = stepper->last.t, resolution = fmin(SHORT / zd_guard_speed(&safeguards->guard), (t1 - t0) / 2);
    resolution = fmax(resolution, ZD_TIME_RESOLUTION * fmax(fabs(t0), fabs(t1)));
    *found = 0;
    int status = zd_rows_find(point);
    if (status || zd_crossing_is_at_one(point)) return status;
    zd_bracket it = zd_bracket_of(t0, t1, 1, zd_crossing_orientation(&safeguards->crossing), resolution);
    if (!(it.gb <= 0)) return ZD_DONE;  /* it changes more than once: shorter steps separate them */
    status = zd_stepper_return(stepper);
    if (!status) status = zd_rows_find(point);
    it.ga = status ? 1 : zd_crossing_orientation(&safeguards->crossing);
    while (!status && it.b - it.a > it.resolution) {
        double t = zd_bracket_choose(&it);
        status = move(stepper, t);
        if (!status) status = zd_rows_find(point);
        *found = !status && zd_crossing_is_at_one(point);
        if (*found) return ZD_DONE;
        if (!status) zd_bracket_narrow(&it, t, zd_crossing_orientation(&safeguards->crossing));
    }
    return status;
}

/* Repeats the step through the bifurcation, if the settings allow it and the motion is continuous there. */
static int pass(zd_step_loop *loop, double t1, double h)
{
    zd_stepper *stepper = loop->stepper;
    zd_crossing *crossing = &loop->safeguards->crossing;
    if (loop->settings->on_singular == ZD_STOP) return ZD_BIFURCATION_PASSED;
    int found, status = find(loop, t1, &found);
    if (status || !found) return status == ZD_CALLBACK || status == ZD_NO_MEMORY ? status : ZD_BRANCH;
    crossing->may_pass = 1;
    status = zd_stepper_return(stepper);
    if (!status) status = integrate_and_finish(loop, h, t1);
    if (zd_variables_lose_digits(stepper, status)) {
        status = zd_step_loop_use_dependent(loop);
        if (!status) status = integrate_and_finish(loop, h, t1);
    }
    crossing->may_pass = 0;
    return status;
}

int zd_passage_land(zd_step_loop *loop, double t1)
{
    double h = loop->stepper->last.h;
    int status = finish_and_check(loop, t1);
    return status == ZD_BIFURCATION_PASSED ? pass(loop, t1, h) : status;
}
