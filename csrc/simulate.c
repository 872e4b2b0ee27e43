/* The outer loop of a run: what precedes a step, the step, events within it, samples that are due; again until the end. */
#include "point/point.h"
#include "run/phases.h"
#include "step/step_loop.h"

enum { CLOCK_EVERY = 16 };      /* steps between readings of the clock */
static const double SLICE = 0.03;   /* s: time slice of zd_run_step() */
static const double ERRORS = 10;    /* tolerances of a step by which an accepted state may be beyond the domain of user functions */

/* True if a step has nothing before it and nothing after it except its sample. */
static int is_plain(const zd_settings *settings)
{
    return !settings->t_eval && !settings->events && !settings->inputs && !settings->is_open;
}

static int take_step(zd_run *run)
{
    const zd_settings *settings = &run->settings;
    int status = zd_run_begin_step(run);
    if (status) return status;
    if (settings->t_eval || settings->events) zd_output_save_start(&run->output);
    if (settings->events) zd_watch_before(&run->watch);
    status = zd_step(&run->loop);
    if (status || !settings->events) return status;
    run->goal.end = run->loop.end;
    status = zd_watch_after(&run->watch, zd_step_loop_is_corrected(&run->loop), &run->loop.end);
    return status || !run->phases ? status : zd_phases_check(run);
}

static int save(zd_run *run, zd_record *record, int forced)
{
    const zd_settings *settings = &run->settings;
    if (!settings->t_eval && !forced && !zd_step_loop_is_due(&run->loop, settings->save_every)) return ZD_DONE;
    int status = settings->t_eval ? zd_output_after(&run->output, record, zd_watch_ends(&run->watch))
                                  : zd_recorder_add(&run->recorder, record);
    run->output.is_waiting = status == ZD_FULL;
    return status;
}

/* Saves the sample of a start, or the one for which the previous record had no room. */
static int begin(zd_run *run, zd_record *record)
{
    if (!record || (run->tally.start_saved && !run->output.is_waiting)) return ZD_DONE;
    run->tally.start_saved = 1;
    return save(run, record, 1);
}

static int has_all_samples(const zd_run *run)
{
    return run->settings.t_eval && !run->settings.events && zd_output_is_complete(&run->output);
}

int zd_run_advance(zd_run *run, zd_record *record, double seconds)
{
    const double deadline = zd_seconds_now() + seconds;
    const int plain = is_plain(&run->settings), meets_breaks = run->motion.system.breaks && zd_is_adaptive(&run->loop);
    const double errors = zd_is_adaptive(&run->loop) ? ERRORS : 0;
    int64_t clock_step = (run->loop.step / CLOCK_EVERY + 1) * CLOCK_EVERY;    /* a slice makes at least one step */
    int status = run->outcome.status ? run->outcome.status : begin(run, record);
    if (!status && zd_inputs_read(run)) return ZD_BAD_INPUT;
    while (!status && run->stepper.t != run->loop.end && run->loop.step < run->goal.step && (plain || !has_all_samples(run))) {
        if (run->loop.step == clock_step) {
            if (zd_seconds_now() >= deadline) return ZD_PAUSED;
            clock_step += CLOCK_EVERY;
        }
        if (meets_breaks) status = zd_pass_break(&run->loop);
        if (!status && (!meets_breaks || run->stepper.t != run->loop.end)) status = plain ? zd_step(&run->loop) : take_step(run);
        if (!status) status = zd_point_check_domain(run->motion.point, errors * run->settings.rtol, errors * run->settings.atol);
        if (!status && record) status = save(run, record, 0);
    }
    if (!status) status = zd_run_act(run);
    return status == ZD_FULL || status == ZD_PAUSED ? status : zd_run_finish(run, status);
}

int zd_run_step(zd_run *run, int64_t steps, zd_record *record)
{
    const int status = zd_run_set_goal(run, steps, INFINITY);
    return status ? status : zd_run_advance(run, record, SLICE);
}
