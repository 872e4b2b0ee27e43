/* The story: a step in time, back onto the constraints, keep what is wanted; again until the end. */
#include <time.h>

#include "core.h"
#include "rank.h"

enum { CLOCK_EVERY = 16 };      /* steps between looks at the clock */

static double now(void)
{
    struct timespec t;
    timespec_get(&t, TIME_UTC);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

int zd_run_integrate(zd_run *run, double h)
{
    int status = run->integrator->step(run->stepper, &run->rate, run->t, h, run->y, &run->statistics);
    if (status) return status;
    return isfinite(zd_max_abs(run->rate.size, run->y)) ? ZD_DONE : ZD_NOT_FINITE;
}

int zd_run_land(zd_run *run, double t1)
{
    const zd_formulation *formulation = run->formulation;
    run->t = t1;
    run->state = run->y;
    if (run->extras) run->point->known &= ~ZD_ACCELERATED;
    int status = formulation->enter(run->solver, run->point, t1, run->y);
    if (!status) status = zd_run_correct(run);
    if (!status) status = formulation->leave(run->solver, run->point, run->y);
    /* Where v follows from the state, it does so to the last bit: the next step then starts from what is known here. */
    return !status && formulation->settle ? formulation->settle(run->solver, run->point) : status;
}

static int take_fixed_step(zd_run *run)
{
    double t1 = zd_run_time(run, run->step);
    int status = zd_run_integrate(run, run->step == run->steps ? t1 - run->t : run->settings.step);
    return status ? status : zd_run_land(run, t1);
}

static int take_step(zd_run *run)
{
    if (run->settings.t_eval) zd_output_before(run);
    run->step++;
    int status = run->settings.step > 0 ? take_fixed_step(run) : zd_control_step(run);
    if (run->point->rank->dropped) run->statistics.rank_drops++;
    run->point->rank->dropped = run->point->rank->near = 0;
    if (!status) run->statistics.steps++;
    return status;
}

static int save(zd_run *run, zd_record *record)
{
    if (run->settings.t_eval) return zd_output_after(run, record);
    return zd_run_is_due(run, run->settings.save_every) ? zd_record_row(run, record) : ZD_DONE;
}

static int is_over(const zd_run *run)
{
    return run->t == run->settings.t1 || (run->settings.t_eval && zd_output_is_complete(run));
}

int zd_run_advance(zd_run *run, zd_record *record, double seconds)
{
    double deadline = now() + seconds;
    long first = run->step;     /* no slice is so short that nothing happens in it */
    int status = run->status;
    if (!status && run->step == 0 && record->rows == 0) status = save(run, record);
    while (!status && !is_over(run)) {
        if (!run->settings.t_eval && record->rows == record->capacity) return ZD_FULL;
        if (run->step > first && run->step % CLOCK_EVERY == 0 && now() > deadline) return ZD_PAUSED;
        status = take_step(run);
        if (!status) status = save(run, record);
    }
    if (status && !run->status) run->status = zd_explain(run, status);
    return run->status;
}
