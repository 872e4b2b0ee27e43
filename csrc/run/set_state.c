/* Another state of a run, at its time. */
#include "../paths/path.h"
#include "../safeguards/safeguards.h"
#include "phases.h"

int zd_run_set_state(zd_run *run, const double *p, const double *v)
{
    zd_motion *motion = &run->motion;
    zd_stepper *stepper = &run->stepper;
    double before = 0, after = 0;
    if (run->phases) return zd_phases_set_state(run, p, v);
    zd_closed_form_leave(motion);
    int status = zd_motion_balance(motion, &before);
    if (!status) status = zd_variables_use_chosen(stepper);
    if (!status) status = zd_stepper_set_state(stepper, stepper->t, p, v);
    if (!status) status = zd_start_check(run, motion->point->rhs);
    if (!status) status = zd_motion_balance(motion, &after);
    if (!status && run->settings.events) status = zd_watch_start(&run->watch);
    if (status) return status;
    zd_motion_add_jump(motion, stepper->t, after - before);
    run->tally.start_saved = run->settings.t_eval != NULL;
    zd_switching_release(&run->loop);
    status = zd_renew(&run->loop);
    return status ? status : zd_safeguards_begin(&run->safeguards, run->loop.step + 1);
}
