/* Step across a bifurcation: bisection by shorter steps decides whether the motion passes through it continuously. */
#include "step_loop.h"

#include <math.h>

#include "../constraints/rank.h"
#include "../linalg/bracket.h"
#include "../step_limits.h"

static const double JUMP = 0.25 * ZD_LIMITS_REGION;     /* in characteristic scales: displacements that only a jump exceeds */

int zd_passage_find(zd_step_loop *loop, double t1, int (*make)(zd_step_loop *loop, double t), int *found)
{
    zd_stepper *stepper = loop->stepper;
    zd_point *point = loop->motion->point;
    const zd_safeguards *safeguards = loop->safeguards;
    double t0 = stepper->last.t, resolution = fmin(JUMP / zd_guard_speed(&safeguards->guard), (t1 - t0) / 2);
    resolution = fmax(resolution, ZD_TIME_RESOLUTION * fmax(fabs(t0), fabs(t1)));
    *found = 0;
    int status = zd_find_independent(point);
    if (status || zd_crossing_is_at_one(point)) return status;
    zd_bracket it = zd_bracket_of(t0, t1, 1, zd_crossing_orientation(&safeguards->crossing), resolution);
    if (!(it.gb <= 0)) return ZD_DONE;  /* it changes more than once: shorter steps separate them */
    status = zd_stepper_return(stepper);
    if (!status) status = zd_find_independent(point);
    it.ga = status ? 1 : zd_crossing_orientation(&safeguards->crossing);
    while (!status && it.b - it.a > it.resolution) {
        double t = zd_bracket_choose(&it);
        status = make(loop, t);
        if (!status) status = zd_find_independent(point);
        *found = !status && zd_crossing_is_at_one(point);
        if (*found) return ZD_DONE;
        if (!status) zd_bracket_narrow(&it, t, zd_crossing_orientation(&safeguards->crossing));
    }
    return status;
}
