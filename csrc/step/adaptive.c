/* Adaptive steps: the controller of Hairer, Norsett and Wanner, section II.4, which is SciPy's.
 *
 * A step is accepted if its error estimate, RMS in units of atol + rtol |y|, is at most one. A step that fails for other reasons
 * (a correction that does not converge, a singular matrix or terms that are not finite at a stage) is repeated with a quarter of its
 * size.
 *
 * The safety factor is below the customary 0.9, with which every fourth step of order eight would be rejected where speeds change as
 * abruptly as in a four-bar. Predictive and proportional-integral controllers were tried and save nothing worth their code.
 */
#include "step_loop.h"

#include <math.h>

#include "../contact/phase_system.h"
#include "../linalg/roots.h"
#include "../linalg/small.h"
#include "../step_limits.h"

static const double AFTER_FAILURE = 0.25;   /* ratio of the size after a failed step to that before */
static const double SHARE_OF_MOVE = 0.9;    /* ratio of the intended change of coordinates to the largest allowed */

zd_control zd_adaptive_create(zd_arena *arena, const zd_stepper *stepper, double t0)
{
    return (zd_control){
        .longest = INFINITY,
        .histogram = zd_step_histogram_create(arena, t0),
        .scale = zd_arena_doubles(arena, stepper->capacity),
        .collapse = zd_collapse_create(arena, stepper->motion->system.nv),
    };
}

/* `a` is finite, or equal to `b`. */
static void set_scale(zd_step_loop *loop, const double *a, const double *b)
{
    const double atol = loop->settings->atol, rtol = loop->settings->rtol;
    double *scale = loop->control.scale;
    for (int i = 0; i < loop->motion->rate.size; i++) {
        const double before = fabs(a[i]), now = fabs(b[i]);
        scale[i] = atol + rtol * (now > before ? now : before);
    }
}

static double bounded(const zd_step_loop *loop, double h)
{
    double longest = loop->settings->max_step > 0 ? loop->settings->max_step : INFINITY;
    return fmin(fmin(h, fmin(longest, loop->control.longest)), zd_step_loop_latest(loop) - loop->stepper->t);
}

/* Size of the first step, from the rate of the state and its change. Times are scaled by the former, so that their unit does not
 * matter. */
int zd_adaptive_start(zd_step_loop *loop, double *work)
{
    const int n = loop->motion->rate.size;
    const zd_settings *settings = loop->settings;
    zd_stepper *stepper = loop->stepper;
    zd_control *control = &loop->control;
    const zd_rate *rate = &loop->motion->rate;
    double *f0 = work, *f1 = f0 + n, *y1 = f1 + n, *y = stepper->y, t = stepper->t;
    zd_collapse_begin(&control->collapse, settings->max_steps);
    control->h = settings->first_step;
    if (!(control->h > 0) && stepper->integrator->predict_step) control->h = INFINITY;
    if (control->h > 0) return ZD_DONE;
    set_scale(loop, y, y);
    int status = rate->evaluate(rate->context, t, y, f0);
    if (status) return status;
    double d0 = zd_root_mean_square(n, y, control->scale), d1 = zd_root_mean_square(n, f0, control->scale);
    double span = settings->t1 - settings->t0, time = d0 < 1e-5 || d1 * span < 1e-5 ? 1e-4 * span : d0 / d1;
    double h0 = bounded(loop, 0.01 * time);
    for (int i = 0; i < n; i++) y1[i] = y[i] + h0 * f0[i];
    status = rate->evaluate(rate->context, t + h0, y1, f1);
    if (status) return status;
    for (int i = 0; i < n; i++) f1[i] -= f0[i];
    double fastest = fmax(time * d1, time * time * zd_root_mean_square(n, f1, control->scale) / h0);
    double h1 = fastest <= 1e-15 ? h0 : time * zd_root(0.01 / fastest, stepper->integrator->card.error_order + 1);
    control->h = fmin(100 * h0, h1);
    return ZD_DONE;
}

/* Counts steps at the stability limit, after enough of them to exclude chance. */
static void watch_stiffness(zd_step_loop *loop, double lambda_h)
{
    zd_control *control = &loop->control;
    if (!(lambda_h > 0)) return;
    if (lambda_h > ZD_STABILITY_LIMIT * loop->stepper->integrator->decay) {
        control->stiffness.at_limit++;
        control->stiffness.below_limit = 0;
        if (control->stiffness.at_limit >= ZD_STIFF_AFTER)
            loop->motion->statistics.stiff += control->stiffness.at_limit == ZD_STIFF_AFTER ? ZD_STIFF_AFTER : 1;
    } else if (++control->stiffness.below_limit >= ZD_NOT_STIFF_AFTER) control->stiffness.at_limit = 0;
}

void zd_adaptive_set_scale(zd_step_loop *loop)
{
    zd_stepper *stepper = loop->stepper;
    if (!stepper->integrator->set_scale) return;
    set_scale(loop, stepper->y, stepper->y);
    stepper->integrator->set_scale(stepper->memory, loop->motion->rate.size, loop->control.scale);
}

/* Shortens the step if the method knows before that it would be too long. */
static int predict_step(zd_step_loop *loop)
{
    zd_stepper *stepper = loop->stepper;
    zd_control *control = &loop->control;
    double longest;
    if (!stepper->integrator->predict_step) return ZD_DONE;
    set_scale(loop, stepper->y, stepper->y);
    int status = stepper->integrator->predict_step(stepper->memory, &loop->motion->rate, stepper->t, stepper->y, control->scale, &longest);
    if (!status && longest < control->h) control->h = longest, control->is_by_move = 0;
    return status;
}

/* Largest change of a coordinate in the step, in units of max_move. The state begins with p, or with its independent entries. */
static double find_move(const zd_step_loop *loop)
{
    const zd_motion *motion = loop->motion;
    const zd_stepper *stepper = loop->stepper;
    const int begins_with_p = motion->formulation->drifts_from & ZD_PHI, n = begins_with_p ? motion->system.nq : motion->formulation_size / 2;
    double largest = 0;
    for (int i = 0; i < n; i++) largest = fmax(largest, fabs(stepper->y[i] - stepper->last.y[i]));
    return largest / loop->settings->max_move;
}

/* Longest step in which no angle changes by more than ZD_LARGEST_TURN at the present velocities; INFINITY without contacts. */
static double find_longest_step(const zd_motion *motion)
{
    const zd_system *system = &motion->system;
    double fastest = 0;
    if (!zd_has_contacts(motion->point->phase)) return INFINITY;
    for (int i = 0; i < system->nv; i++)
        if (!(system->lengths && system->lengths[system->nq + i])) fastest = fmax(fastest, fabs(motion->point->v[i]));
    return ZD_LARGEST_TURN / fastest;
}

static int estimate(zd_step_loop *loop, const zd_attempt *attempt)
{
    zd_stepper *stepper = loop->stepper;
    zd_control *control = &loop->control;
    double lambda_h;
    set_scale(loop, stepper->last.y, stepper->y);
    int status = stepper->integrator->error(stepper->memory, &loop->motion->rate, attempt->t1, attempt->h, stepper->y, control->scale,
                                            &control->norm, &lambda_h);
    if (status) return status;
    if (isnan(control->norm)) return ZD_NOT_FINITE;
    control->move = loop->settings->max_move > 0 ? find_move(loop) : 0;
    if (zd_control_accepts(control) && !loop->switching.holds) watch_stiffness(loop, lambda_h);
    return ZD_DONE;
}

static double factor(const zd_step_loop *loop, double norm)
{
    if (norm == 0) return ZD_MAX_FACTOR;
    double wanted = ZD_SAFETY / zd_root(norm, loop->stepper->integrator->card.error_order + 1);
    return fmin(ZD_MAX_FACTOR, fmax(ZD_MIN_FACTOR, wanted));
}

/* Size of the next step after one of size h, bounded by max_move. */
static double by_move(zd_control *control, double h, double next)
{
    const double longest = control->move > 0 ? h * SHARE_OF_MOVE / control->move : INFINITY;
    control->is_by_move = longest < next;
    return control->is_by_move ? longest : next;
}

/* True if a shorter step would fail likewise. */
static int is_final(const zd_step_loop *loop, int status)
{
    if (status == ZD_CALLBACK) return !loop->motion->point->left_domain;
    return status == ZD_NO_MEMORY || status == ZD_BIFURCATION || status == ZD_NOT_SYMMETRIC || status == ZD_NOT_JACOBIAN;
}

static int begin(zd_step_loop *loop)
{
    const int64_t most = loop->settings->max_steps;
    if (most && loop->step > most) return ZD_TOO_MANY_STEPS;
    loop->control.norm = 0;
    loop->control.largest_factor = ZD_MAX_FACTOR;
    loop->control.longest = find_longest_step(loop->motion);
    const double latest = zd_step_loop_latest(loop);
    loop->control.smallest = 16 * 0x1p-52 * fmax(fabs(loop->stepper->t), isfinite(latest) ? fabs(latest) : 0);
    const int status = loop->switching.count ? zd_switching_begin(loop) : ZD_DONE;
    return status ? status : predict_step(loop);
}

static int next(zd_step_loop *loop, zd_attempt *attempt)
{
    const double t = loop->stepper->t, latest = zd_step_loop_latest(loop), h = loop->control.bounded = bounded(loop, loop->control.h);
    attempt->t1 = h == latest - t ? latest : t + h;
    attempt->h = attempt->t1 - t;
    attempt->forced = attempt->t1 == latest || loop->parts;
    return attempt->t1 > t ? ZD_DONE : ZD_TINY_STEP;
}

/* ZD_COLLAPSED if the run has made so many steps at one place that get nowhere. */
static int watch_collapse(zd_step_loop *loop)
{
    zd_control *control = &loop->control;
    const zd_settings *settings = loop->settings;
    const double h = control->bounded, span = (settings->is_open ? loop->stepper->t : settings->t1) - settings->t0;
    if (!(h < control->collapse.share * span) || control->stiffness.at_limit || control->is_by_move) {
        control->collapse.count = 0;
        return ZD_DONE;
    }
    const int is_cut = loop->switching.is_cut;
    const double *scale = is_cut ? NULL : control->scale;
    if ((h != control->h && !is_cut) || !zd_collapse_count(&control->collapse, loop->stepper, h, scale)) return ZD_DONE;
    loop->motion->statistics.part = zd_collapse_velocity(&control->collapse, loop->motion->system.nv);
    return ZD_COLLAPSED;
}

static int accept(zd_step_loop *loop)
{
    const zd_integrator *integrator = loop->stepper->integrator;
    zd_control *control = &loop->control;
    const double h = control->bounded, intended = control->h;
    const int status = watch_collapse(loop);
    control->h = by_move(control, h, h * fmin(control->largest_factor, factor(loop, control->norm)));
    if (loop->stepper->t == zd_step_loop_latest(loop)) control->h = fmax(control->h, intended);     /* as if it had not been cut */
    if (loop->switching.is_cut) control->h = intended;
    if (integrator->limit_step) control->h = integrator->limit_step(loop->stepper->memory, control->h);
    zd_step_histogram_step(&control->histogram, loop->stepper->t);
    return status;
}

static int repeats(zd_step_loop *loop, int *status)
{
    zd_control *control = &loop->control;
    const double h = control->bounded;
    const int is_accepted = !*status && zd_control_accepts(control);
    if (loop->switching.count && zd_switching_repeats(loop, status)) return 1;
    if (is_accepted) {
        if (!*status) *status = accept(loop);
        return 0;
    }
    if (is_final(loop, *status)) return 0;
    loop->motion->statistics.rejected++;
    if (*status) control->h = h * AFTER_FAILURE, control->is_by_move = 0;
    else control->h = by_move(control, h, h * fmin(1, factor(loop, control->norm)));
    control->largest_factor = 1;
    if (!(control->h > control->smallest)) {
        if (!*status) *status = ZD_TINY_STEP;
        return 0;
    }
    *status = zd_stepper_return(loop->stepper);
    return !*status;
}

const zd_step_sizes zd_adaptive_sizes = {begin, next, zd_adaptive_set_scale, estimate, repeats};
