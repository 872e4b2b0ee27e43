/* Steps of the size that the error asked for allows: the controller of Hairer, Norsett and Wanner, section II.4, which is SciPy's.
 *
 * A step is accepted where the estimate, root mean square in units of atol + rtol |y|, is at most one. A step that fails for other
 * reasons (a correction that does not converge, a matrix that is singular on the way) is tried again at a quarter of its size.
 *
 * The safety factor is below the customary 0.9: where speeds change as abruptly as in a four-bar, every fourth step of order eight
 * would be rejected. Measured over four mechanisms, 0.8 takes a tenth fewer evaluations for the same error; a predictive
 * controller takes one percent fewer still, proportional-integral ones take more.
 */
#include "adaptive.h"

#include <math.h>

#include "../linalg/norms.h"
#include "../linalg/roots.h"
#include "passage.h"
#include "road.h"
#include "short_step.h"
#include "variables.h"

enum {
    STIFF_AFTER = 10,       /* steps as long as stability allows: then the problem counts as stiff */
    NOT_STIFF_AFTER = 3,    /* shorter steps in succession: then it no longer does */
};
static const double AT_THE_LIMIT = 0.95;    /* of the largest |lambda h| that is stable */
static const double SAFETY = 0.8, SMALLEST = 0.2, LARGEST = 10, AFTER_FAILURE = 0.25;
static const double SHARE_OF_MOVE = 0.9;    /* of the largest move that is allowed: what steps aim at */

zd_control zd_adaptive_take(zd_arena *arena, const zd_stepper *stepper, double t0)
{
    return (zd_control){
        .pace = zd_pace_take(arena, t0),
        .scale = zd_take_doubles(arena, (size_t)stepper->capacity),
    };
}

static void set_scale(zd_course *course, const double *a, const double *b)
{
    for (int i = 0; i < course->motion->rate.size; i++)
        course->control.scale[i] = course->settings->atol + course->settings->rtol * fmax(fabs(a[i]), fabs(b[i]));
}

static double bounded(const zd_course *course, double h)
{
    double longest = course->settings->max_step > 0 ? course->settings->max_step : INFINITY;
    return fmin(fmin(h, longest), course->end - course->stepper->t);
}

/* The first step: from how fast the state changes, and how fast that does. All times are measured by the former, so that their
 * unit makes no difference. */
int zd_adaptive_start(zd_course *course, double *work)
{
    const int n = course->motion->rate.size;
    const zd_settings *settings = course->settings;
    zd_stepper *stepper = course->stepper;
    zd_control *control = &course->control;
    const zd_rate *rate = &course->motion->rate;
    double *f0 = work, *f1 = f0 + n, *y1 = f1 + n, *y = stepper->y, t = stepper->t;
    control->h = settings->first_step;
    if (!(control->h > 0) && stepper->integrator->foresee) control->h = INFINITY;
    if (control->h > 0) return ZD_DONE;
    set_scale(course, y, y);
    int status = rate->evaluate(rate->context, t, y, f0);
    if (status) return status;
    double d0 = zd_root_mean_square(n, y, control->scale), d1 = zd_root_mean_square(n, f0, control->scale);
    double span = settings->t1 - settings->t0, time = d0 < 1e-5 || d1 * span < 1e-5 ? 1e-4 * span : d0 / d1;
    double h0 = bounded(course, 0.01 * time);
    for (int i = 0; i < n; i++) y1[i] = y[i] + h0 * f0[i];
    status = rate->evaluate(rate->context, t + h0, y1, f1);
    if (status) return status;
    for (int i = 0; i < n; i++) f1[i] -= f0[i];
    double fastest = fmax(time * d1, time * time * zd_root_mean_square(n, f1, control->scale) / h0);
    double h1 = fastest <= 1e-15 ? h0 : time * zd_root(0.01 / fastest, stepper->integrator->card.error_order + 1);
    control->h = fmin(100 * h0, h1);
    return ZD_DONE;
}

/* Counts steps that are as long as stability allows, once there are enough of them to rule out chance. */
static void watch_stiffness(zd_course *course, double lambda_h)
{
    zd_control *control = &course->control;
    if (!(lambda_h > 0)) return;
    if (lambda_h > AT_THE_LIMIT * course->stepper->integrator->decay) {
        control->at_limit++;
        control->below_limit = 0;
        if (control->at_limit >= STIFF_AFTER) course->motion->statistics.stiff += control->at_limit == STIFF_AFTER ? STIFF_AFTER : 1;
    } else if (++control->below_limit >= NOT_STIFF_AFTER) control->at_limit = 0;
}

void zd_adaptive_weigh(zd_course *course)
{
    zd_stepper *stepper = course->stepper;
    if (!stepper->integrator->weigh) return;
    set_scale(course, stepper->y, stepper->y);
    stepper->integrator->weigh(stepper->memory, course->motion->rate.size, course->control.scale);
}

/* No step is begun that is known to be too long. */
static int foresee(zd_course *course)
{
    zd_stepper *stepper = course->stepper;
    zd_control *control = &course->control;
    double longest;
    if (!stepper->integrator->foresee) return ZD_DONE;
    set_scale(course, stepper->y, stepper->y);
    int status = stepper->integrator->foresee(stepper->memory, &course->motion->rate, stepper->t, stepper->y, control->scale, &longest);
    if (!status) control->h = fmin(control->h, longest);
    return status;
}

/* The largest change of a coordinate in the step that was integrated, in units of max_move. The state begins with p, or with those of its
 * entries that are independent. */
static double find_move(const zd_course *course)
{
    const zd_motion *motion = course->motion;
    const zd_stepper *stepper = course->stepper;
    const int begins_with_p = motion->formulation->drifts_from & ZD_PHI, n = begins_with_p ? motion->system.nq : motion->formulation_size / 2;
    double largest = 0;
    for (int i = 0; i < n; i++) largest = fmax(largest, fabs(stepper->y[i] - stepper->last.y[i]));
    return largest / course->settings->max_move;
}

/* A step of size h to t1, with the norm of its error; corrected only if that is small enough. */
static int attempt(zd_course *course, double h, double t1, double *norm)
{
    zd_stepper *stepper = course->stepper;
    const int is_short = zd_is_short(course->motion);
    zd_adaptive_weigh(course);
    int status = is_short ? zd_short_integrate(course, h) : zd_stepper_integrate(stepper, h);
    if (status) return status;
    set_scale(course, stepper->last.y, stepper->y);
    double lambda_h;
    status = stepper->integrator->error(stepper->memory, &course->motion->rate, t1, h, stepper->y, course->control.scale, norm, &lambda_h);
    if (status) return status;
    if (isnan(*norm)) return ZD_NOT_FINITE;
    course->control.move = course->settings->max_move > 0 ? find_move(course) : 0;
    if (!(*norm <= 1 && course->control.move <= 1)) return ZD_DONE;
    watch_stiffness(course, lambda_h);
    return is_short ? zd_short_land(course, t1) : zd_passage_land(course, t1);
}

/* Where the direct road is left, the step has been looked at for stiffness once already. */
static int attempt_on_either_road(zd_course *course, double h, double t1, double *norm)
{
    const zd_control before = course->control;
    const int64_t stiff = course->motion->statistics.stiff;
    int status = attempt(course, h, t1, norm);
    if (!zd_road_is_left(course, status)) return status;
    course->control.at_limit = before.at_limit;
    course->control.below_limit = before.below_limit;
    course->motion->statistics.stiff = stiff;
    status = zd_road_leave(course);
    return status ? status : attempt(course, h, t1, norm);
}

static double factor(const zd_course *course, double norm)
{
    if (norm == 0) return LARGEST;
    double wanted = SAFETY / zd_root(norm, course->stepper->integrator->card.error_order + 1);
    return fmin(LARGEST, fmax(SMALLEST, wanted));
}

/* The size of the next step after one of size h, as far as the move of that one allows. */
static double by_move(const zd_course *course, double h, double next)
{
    const double move = course->control.move;
    return move > 0 ? fmin(next, h * SHARE_OF_MOVE / move) : next;
}

/* What a shorter step does not help against. */
static int is_final(int status)
{
    return status == ZD_CALLBACK || status == ZD_NO_MEMORY || status == ZD_BIFURCATION || status == ZD_NOT_SYMMETRIC
           || status == ZD_NOT_JACOBIAN;
}

int zd_adaptive_step(zd_course *course)
{
    const int64_t most = course->settings->max_steps;
    if (most && course->step > most) return ZD_TOO_MANY_STEPS;
    double t = course->stepper->t, norm = 0, largest = LARGEST;
    double tiny = 16 * 0x1p-52 * fmax(fabs(t), fabs(course->end));
    int foreseen = foresee(course);
    if (foreseen) return foreseen;
    for (;;) {
        double h = bounded(course, course->control.h), t1 = h == course->end - t ? course->end : t + h;
        if (!(t1 > t)) return ZD_TINY_STEP;
        int status = attempt_on_either_road(course, t1 - t, t1, &norm);
        if (zd_variables_lose_digits(course->stepper, status)) {
            status = zd_course_use_dependent(course);
            if (!status) status = attempt(course, t1 - t, t1, &norm);
        }
        if (!status && norm <= 1 && course->control.move <= 1) {
            course->control.h = by_move(course, h, h * fmin(largest, factor(course, norm)));
            if (course->stepper->integrator->fit)
                course->control.h = course->stepper->integrator->fit(course->stepper->memory, course->control.h);
            zd_pace_step(&course->control.pace, t1);
            return ZD_DONE;
        }
        if (is_final(status)) return status;
        course->motion->statistics.rejected++;
        course->control.h = status ? h * AFTER_FAILURE : by_move(course, h, h * fmin(1, factor(course, norm)));
        largest = 1;
        if (!(course->control.h > tiny)) return status ? status : ZD_TINY_STEP;
        status = zd_stepper_return(course->stepper);
        if (status) return status;
    }
}
