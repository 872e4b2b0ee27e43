/* The outer loop of a run: one step, events within it, samples that are due; again until the end. */
#include <math.h>

#include "run/run.h"
#include "step/step_loop.h"

enum { CLOCK_EVERY = 16 };      /* steps between readings of the clock */
static const double SLICE = 0.03;   /* s: time slice of zd_run_step() */

/* True if a step has nothing before it and nothing after it except its sample: no events, inputs, output times, or return after a failure. */
static int is_plain(const zd_settings *settings)
{
    return !settings->t_eval && !settings->events && !settings->inputs && !settings->is_open;
}

static int take_step(zd_run *run)
{
    const zd_settings *settings = &run->settings;
    if (settings->t_eval || settings->events) zd_output_save_start(&run->output);
    if (settings->events) zd_watch_before(&run->watch);
    int status = zd_step(&run->loop);
    if (status || !settings->events) return status;
    return zd_watch_after(&run->watch, zd_step_loop_is_corrected(&run->loop), &run->loop.end);
}

static int save(zd_run *run, zd_record *record)
{
    const zd_settings *settings = &run->settings;
    if (!settings->t_eval && !zd_step_loop_is_due(&run->loop, settings->save_every)) return ZD_DONE;
    int status = settings->t_eval ? zd_output_after(&run->output, record, run->watch.ended) : zd_recorder_add(&run->recorder, record);
    run->output.is_waiting = status == ZD_FULL;
    return status;
}

static int has_all_samples(const zd_run *run)
{
    const zd_settings *settings = &run->settings;
    return settings->t_eval && !settings->events && zd_output_is_complete(&run->output);
}

/* Saves the sample of the start, or the one for which the previous record had no room. */
static int begin(zd_run *run, zd_record *record)
{
    if (!record || (run->tally.start_saved && !run->output.is_waiting)) return ZD_DONE;
    run->tally.start_saved = 1;
    return save(run, record);
}

/* A step that ends where a speed has followed its input, if that comes first. */
static int take_step_within_ramp(zd_run *run)
{
    const double end = run->loop.end;
    run->loop.end = fmin(end, zd_inputs_next_end(run));
    const int status = take_step(run);
    if (!run->watch.ended) run->loop.end = end;
    return status;
}

/* One step with what precedes it. An open run can go on after a step that failed: it returns to the start of that step. */
static int go_on(zd_run *run)
{
    if (run->settings.is_open) zd_run_save_good(run);
    const zd_inputs *inputs = run->settings.inputs;
    int status = inputs ? zd_inputs_begin_step(run) : ZD_DONE;
    if (status) return status;
    return inputs && inputs->ramp > 0 ? take_step_within_ramp(run) : take_step(run);
}

/* Explains why the run ends, or why an open run stops before its goal. */
static int finish(zd_run *run, int status)
{
    zd_outcome *outcome = &run->outcome;
    if (!status && run->watch.ended) status = ZD_EVENT;
    if (!status || outcome->status) return outcome->status;
    outcome->status = zd_explain(run, status);
    if (!run->settings.is_open || outcome->status > 0) return outcome->status;
    status = outcome->status;
    if (!zd_run_return_to_good(run)) outcome->status = ZD_DONE;
    return status;
}

int zd_run_advance(zd_run *run, zd_record *record, double seconds)
{
    double deadline = zd_seconds_now() + seconds;
    const int plain = is_plain(&run->settings);
    int64_t clock_step = (run->loop.step / CLOCK_EVERY + 1) * CLOCK_EVERY;    /* a slice makes at least one step */
    int status = run->outcome.status ? run->outcome.status : begin(run, record);
    if (!status && zd_inputs_read(run)) return ZD_BAD_INPUT;
    while (!status && run->stepper.t != run->loop.end && run->loop.step < run->goal.step && (plain || !has_all_samples(run))) {
        if (run->loop.step == clock_step) {
            if (zd_seconds_now() >= deadline) return ZD_PAUSED;
            clock_step += CLOCK_EVERY;
        }
        status = plain ? zd_step(&run->loop) : go_on(run);
        if (!status && record) status = save(run, record);
    }
    return status == ZD_FULL ? status : finish(run, status);
}

int zd_run_step(zd_run *run, int64_t steps, zd_record *record)
{
    const int status = zd_run_set_goal(run, steps, INFINITY);
    return status ? status : zd_run_advance(run, record, SLICE);
}
