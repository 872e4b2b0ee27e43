/* Columns of a record that runs in lanes do not compute, from the saved states, by the matrix path. */
#include "../run/run.h"

static int record_sample(zd_run *run, double t, const double *p, const double *v, double input, zd_record *record)
{
    int status = zd_stepper_set_state(&run->stepper, t, p, v);
    if (run->motion.balance.input) run->stepper.y[run->motion.rate.size - 1] = input;
    return status ? status : zd_recorder_add(&run->recorder, record);
}

int zd_run_record_states(zd_run *run, int64_t rows, const double *t, const double *p, const double *v, const double *input, zd_record *record)
{
    const zd_system *system = &run->motion.system;
    int status = ZD_DONE;
    for (int64_t i = 0; i < rows && !status; i++)
        status = record_sample(run, t[i], p + i * system->nq, v + i * system->nv, input[i], record);
    return status ? zd_explain(run, status) : ZD_DONE;
}
