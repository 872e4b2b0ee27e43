/* Fixed steps. One that cannot be corrected or is not accepted is repeated in equal parts: two, four, eight; if these fail, too, the run
 * fails.
 */
#include "step_loop.h"

#include <math.h>

#include "../step_limits.h"

enum { MAX_PARTS = 8 };    /* largest number of parts of a step that fails */

static int next_part(zd_step_loop *loop, zd_attempt *attempt, double t1)
{
    const double t0 = loop->undivided.t;
    attempt->t1 = loop->part == loop->parts ? t1 : t0 + (t1 - t0) * loop->part / loop->parts;
    attempt->h = attempt->t1 - loop->stepper->t;
    attempt->forced = 1;
    return ZD_DONE;
}

/* Time at the end of a fixed step; the last one ends at `end`. Never accumulated, so that slices of a run do not change it. */
static double time_of_step(const zd_step_loop *loop, double size)
{
    return loop->step == loop->steps ? loop->end : loop->t_begin + (double)(loop->step - loop->steps_before) * size;
}

static int next(zd_step_loop *loop, zd_attempt *attempt)
{
    const double step = loop->settings->step, t1 = time_of_step(loop, step), size = t1 - loop->stepper->t;
    const double rounding = ZD_TIME_RESOLUTION * fmax(fabs(loop->t_begin), fabs(t1));
    if (loop->parts) return next_part(loop, attempt, t1);
    attempt->t1 = t1;
    attempt->h = fabs(size - step) > rounding ? size : step;       /* shorter: the last one, and after an event */
    attempt->forced = t1 == loop->end;
    return ZD_DONE;
}

static int is_too_far(int status)
{
    return status == ZD_NO_CONVERGENCE || status == ZD_BRANCH || status == ZD_NO_EMBEDDING || status == ZD_BIFURCATION_PASSED;
}

/* Returns to the start of the undivided step, to repeat it in twice as many parts. */
static int divide(zd_step_loop *loop, int *status)
{
    for (;;) {
        loop->parts *= 2;
        if (!is_too_far(*status) || loop->parts > MAX_PARTS) return 0;
        loop->part = 1;
        *status = zd_stepper_return_to(loop->stepper, &loop->undivided);
        if (!*status) *status = zd_safeguards_begin(loop->safeguards, loop->step + 1);
        if (!*status) return 1;
    }
}

static int begin_parts(zd_step_loop *loop, int *status)
{
    zd_stepper *stepper = loop->stepper;
    const int returned = zd_stepper_return(stepper);
    zd_stepper_save_state(stepper, &loop->undivided);
    loop->parts = 1;
    if (!returned) return divide(loop, status);
    *status = returned;
    return 0;
}

static int repeats(zd_step_loop *loop, int *status)
{
    if (!loop->parts) return is_too_far(*status) ? begin_parts(loop, status) : 0;
    if (*status) return divide(loop, status);
    if (loop->part++ < loop->parts) return 1;
    loop->parts = 0;
    loop->motion->statistics.subdivided++;
    return 0;
}

const zd_step_sizes zd_fixed_sizes = {.next = next, .repeats = repeats};
