/* The story: a step in time, back onto the constraints, keep what is wanted; again until the end. */
#include <time.h>

#include "core.h"
#include "linalg/small.h"
#include "constraints/rank.h"

enum { CLOCK_EVERY = 16, MOST_PARTS = 8 };     /* steps between looks at the clock; of a step that cannot be corrected */

static double now(void)
{
    struct timespec t;
    timespec_get(&t, TIME_UTC);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void remember(zd_run *run, double h)
{
    run->last.t = run->t;
    run->last.h = h;
    zd_copy(run->rate.size, run->y, run->last.y);
    ZD_SIZED(zd_copy, run->system.nq, run->point->p, run->last.p);
    ZD_SIZED(zd_copy, run->system.nv, run->point->v, run->last.v);
}

int zd_run_return(zd_run *run)
{
    run->t = run->last.t;
    run->state = run->y;
    zd_copy(run->rate.size, run->last.y, run->y);
    zd_point_move(run->point, run->last.t, run->last.p, run->last.v);
    return run->formulation->settle ? run->formulation->leave(run->solver, run->point, run->y) : ZD_DONE;   /* in what variables, may be anew */
}

int zd_run_make_step(zd_run *run, double h)
{
    const zd_integrator *integrator = run->integrator;
    return integrator->step_of_run ? integrator->step_of_run(run->stepper, run, h)
         : integrator->step(run->stepper, &run->rate, run->t, h, run->y, &run->statistics);
}

int zd_run_integrate(zd_run *run, double h)
{
    remember(run, h);
    int status = zd_run_make_step(run, h);
    if (status) return status;
    return isfinite(zd_max_abs(run->rate.size, run->y)) ? ZD_DONE : ZD_NOT_FINITE;
}

int zd_run_land(zd_run *run, double t1)
{
    const zd_formulation *formulation = run->formulation;
    double h = t1 - run->t;
    run->t = t1;
    run->state = run->y;
    if (run->extras) run->point->known &= ~ZD_ACCELERATED;
    int status = formulation->enter(run->solver, run->point, t1, run->y);
    if (!status) status = zd_run_correct(run);
    if (!status) status = formulation->leave(run->solver, run->point, run->y);
    /* Where v follows from the state, it does so to the last bit: the next step then starts from what is known here. */
    if (!status && formulation->settle) status = formulation->settle(run->solver, run->point);
    if (!status && !zd_point_is_finite(run->point)) status = ZD_NOT_FINITE;
    return status ? status : zd_guard_step(run, h);
}

int zd_run_step(zd_run *run, double h, double t1)
{
    int status = zd_run_integrate(run, h);
    if (!status) status = zd_run_land(run, t1);
    return status == ZD_PASSED ? zd_crossing_pass(run, h, t1) : status;
}

/* From where the step began to t1, in equal parts. */
static int take_parts(zd_run *run, double t1)
{
    const double t0 = run->whole.t;
    int status = zd_place_return(run, &run->whole);
    if (!status) status = zd_guard_begin(run);
    for (int part = 1; !status && part <= run->parts; part++) {
        double t = part == run->parts ? t1 : t0 + (t1 - t0) * part / run->parts;
        status = zd_run_step(run, t - run->t, t);
    }
    return status;
}

static void remember_whole(zd_run *run)
{
    const zd_last *last = &run->last;
    run->whole.t = last->t;
    zd_copy(run->system.nq, last->p, run->whole.p);
    zd_copy(run->system.nv, last->v, run->whole.v);
    zd_copy(run->rate.size - run->own_size, last->y + run->own_size, run->whole.extra);
}

static int is_too_far(int status)
{
    return status == ZD_NO_CONVERGENCE || status == ZD_BRANCH || status == ZD_NO_EMBEDDING || status == ZD_PASSED;
}

/* A step that has led too far away to be corrected is made in parts; if that does not help, either, it stays so and is named. */
static int divide_step(zd_run *run, int status, double t1)
{
    remember_whole(run);
    for (run->parts = 2; is_too_far(status) && run->parts <= MOST_PARTS; run->parts *= 2) {
        int again = take_parts(run, t1);
        if (!again) {
            run->parts = 0;
            run->statistics.subdivided++;
            return ZD_DONE;
        }
        status = again;
    }
    return status;
}

static int take_fixed_step(zd_run *run)
{
    double t1 = zd_run_time(run, run->step);
    int status = zd_run_step(run, run->step == run->steps ? t1 - run->t : run->settings.step, t1);
    return is_too_far(status) && run->guard.kept ? divide_step(run, status, t1) : status;
}

static int take_step(zd_run *run)
{
    if (run->settings.t_eval || run->settings.events) zd_output_before(run);
    run->step++;
    int status = run->settings.step > 0 ? take_fixed_step(run) : zd_control_step(run);
    if (run->point->rank->dropped) run->statistics.rank_drops++;
    run->point->rank->dropped = run->point->rank->near = 0;
    if (!status) run->statistics.steps++;
    return !status && run->settings.events ? zd_events_after(run) : status;
}

static int save(zd_run *run, zd_record *record)
{
    if (run->settings.t_eval) return zd_output_after(run, record);
    return zd_run_is_due(run, run->settings.save_every) ? zd_record_row(run, record) : ZD_DONE;
}

static int is_over(const zd_run *run)
{
    return run->t == run->settings.t1 || (run->settings.t_eval && !run->settings.events && zd_output_is_complete(run));
}

/* A step may bring all the times that are left of t_eval, and the end by an event. */
static int has_room(const zd_run *run, const zd_record *record)
{
    long left = record->capacity - record->rows;
    if (!run->settings.t_eval) return left > 0;
    return left >= run->settings.t_evals - run->output.next + (run->settings.events != NULL);
}

int zd_run_advance(zd_run *run, zd_record *record, double seconds)
{
    double deadline = now() + seconds;
    long first = run->step;     /* no slice is so short that nothing happens in it */
    int status = run->status;
    if (!status && !run->begun) {
        if (!has_room(run, record)) return ZD_FULL;
        run->begun = 1;
        status = save(run, record);
    }
    while (!status && !is_over(run)) {
        if (!has_room(run, record)) return ZD_FULL;
        if (run->step > first && run->step % CLOCK_EVERY == 0 && now() > deadline) return ZD_PAUSED;
        status = take_step(run);
        if (!status) status = save(run, record);
    }
    if (!status && run->watch.ended) status = ZD_EVENT;
    if (status && !run->status) run->status = zd_explain(run, status);
    return run->status;
}
