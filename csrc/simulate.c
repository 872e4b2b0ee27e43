/* The outer loop of a run: one step, events within it, samples that are due; again until the end. */
#include "run/explain.h"
#include "run/run.h"
#include "step/clock.h"
#include "step/step.h"

enum { CLOCK_EVERY = 16 };      /* steps between readings of the clock */

static int take_step(zd_run *run)
{
    const zd_settings *settings = &run->settings;
    if (settings->t_eval || settings->events) zd_output_keep_beginning(&run->output);
    int status = zd_step(&run->loop);
    if (status || !settings->events) return status;
    return zd_watch_after(&run->watch, zd_step_loop_is_corrected(&run->loop), &run->loop.end);
}

static int save_what_is_due(zd_run *run, zd_record *record)
{
    const zd_settings *settings = &run->settings;
    if (settings->t_eval) return zd_output_after(&run->output, record, run->watch.ended);
    return zd_step_loop_is_due(&run->loop, settings->save_every) ? zd_recorder_add(&run->recorder, record) : ZD_DONE;
}

static int save(zd_run *run, zd_record *record)
{
    int status = save_what_is_due(run, record);
    run->output.is_waiting = status == ZD_FULL;
    return status;
}

static int is_over(const zd_run *run)
{
    const zd_settings *settings = &run->settings;
    return run->stepper.t == run->loop.end || (settings->t_eval && !settings->events && zd_output_is_complete(&run->output));
}

/* Saves the sample of the start, or the one for which the previous record had no room. */
static int begin(zd_run *run, zd_record *record)
{
    if (run->tally.start_saved && !run->output.is_waiting) return ZD_DONE;
    run->tally.start_saved = 1;
    return save(run, record);
}

int zd_run_advance(zd_run *run, zd_record *record, double seconds)
{
    double deadline = zd_seconds_now() + seconds;
    const int64_t first = run->loop.step;    /* each slice makes at least one step */
    int status = run->outcome.status;
    if (!status) status = begin(run, record);
    while (!status && !is_over(run)) {
        const int64_t step = run->loop.step;
        if (step > first && step % CLOCK_EVERY == 0 && zd_seconds_now() >= deadline) return ZD_PAUSED;
        status = take_step(run);
        if (!status) status = save(run, record);
    }
    if (status == ZD_FULL) return status;
    if (!status && run->watch.ended) status = ZD_EVENT;
    if (status && !run->outcome.status) run->outcome.status = zd_explain(run, status);
    return run->outcome.status;
}
