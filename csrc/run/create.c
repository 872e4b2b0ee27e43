/* Creation of a run: checks of its arguments and of its start. */
#include <stdio.h>

#include "../paths/path.h"
#include "../registry.h"
#include "arguments/checks.h"
#include "phases.h"
#include "run.h"

void zd_run_free(zd_run *run)
{
    if (!run) return;
    if (run->phases) {
        zd_phases_free(run);
        return;
    }
    zd_memory_free(run->start);
    zd_plan_free(run);
}

static zd_run *refuse(zd_run *run, int why, int *status, char *message, int size)
{
    *status = zd_explain(run, why);
    snprintf(message, size, "%s", run->outcome.message);
    zd_run_free(run);
    return NULL;
}

zd_run *zd_run_create(const zd_system *system, const zd_settings *settings, const double *p0, const double *v0,
                      int *status, char *message, int message_size)
{
    *status = zd_check_run(system, settings, message, message_size);
    if (!*status) *status = zd_check_quaternions(system, p0, 0, message, message_size);
    if (*status) return NULL;
    const int suits = zd_phases_suit(system, settings->integrator);
    if (!suits) *status = ZD_UNSUITED_INTEGRATOR;
    if (!suits) snprintf(message, message_size, "'%s' must have a system without dry friction, which sticks by constraints on velocities",
                         zd_integrator_of(settings->integrator)->card.name);
    if (!suits) return NULL;
    zd_phases *phases = system->groups ? zd_phases_create(system, settings) : NULL;
    zd_phase *first = phases ? zd_phases_find(phases, phases->state) : NULL;
    if (first) system = &first->of->system, settings = &phases->settings;
    else if (system->groups) *status = ZD_NO_MEMORY;
    zd_run *run = *status ? NULL : zd_run_open(NULL, system, settings, settings->t0, p0, v0, status, message, message_size);
    if (!run) return NULL;
    if (phases) zd_phases_attach(run, phases);
    if (settings->steps == ZD_FIXED_STEPS) run->loop.steps = (int64_t)zd_count_steps(settings->t0, settings->t1, settings->step);
    int why = zd_run_start(run, *status, p0, v0);
    if (!why && zd_output_interpolates(&run->output)) why = zd_dense_output_create(&run->stepper);
    if (!why && phases) why = zd_phases_change(run, NULL, 1);
    *status = why;
    if (settings->is_open) zd_run_remove_end(run);
    return why ? refuse(run, why, status, message, message_size) : run;
}
