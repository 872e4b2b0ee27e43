/* The story: a step in time, back onto the constraints, keep what is wanted; again until the end. */
#include <time.h>

#include "core.h"

enum { CLOCK_EVERY = 16 };      /* steps between looks at the clock */

static double now(void)
{
    struct timespec t;
    timespec_get(&t, TIME_UTC);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static int take_step(zd_run *run)
{
    double t = zd_run_time(run, run->step), t1 = zd_run_time(run, run->step + 1);
    double h = run->step + 1 == run->steps ? t1 - t : run->settings.step;
    int status = run->integrator->step(run->stepper, &run->rate, t, h, run->y, &run->statistics);
    if (status) return status;
    run->step++;
    run->statistics.steps++;
    if (!isfinite(zd_max_abs(run->rate.size, run->y))) return ZD_NOT_FINITE;

    run->state = run->y;
    if (run->extras) run->point->known &= ~ZD_ACCELERATED;
    status = run->formulation->enter(run->solver, run->point, t1, run->y);
    if (!status) status = zd_run_correct(run);
    if (!status) status = run->formulation->leave(run->solver, run->point, run->y);
    /* Where v follows from the state, it does so to the last bit: the next step then starts from what is known here. */
    return !status && run->formulation->settle ? run->formulation->settle(run->solver, run->point) : status;
}

int zd_run_advance(zd_run *run, zd_record *record, double seconds)
{
    double deadline = now() + seconds;
    long first = run->step;     /* no slice is so short that nothing happens in it */
    int status = run->status;
    if (!status && run->step == 0 && record->rows == 0) status = zd_record_row(run, record);
    while (!status && run->step < run->steps) {
        if (record->rows == record->capacity) return ZD_FULL;
        if (run->step > first && run->step % CLOCK_EVERY == 0 && now() > deadline) return ZD_PAUSED;
        status = take_step(run);
        if (!status && zd_run_is_due(run, run->settings.save_every)) status = zd_record_row(run, record);
    }
    if (status && !run->status) run->status = zd_explain(run, status);
    return run->status;
}
