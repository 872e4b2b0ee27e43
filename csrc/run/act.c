/* Actions at events, between two steps: inputs are set, or the caller acts, and the run goes on. A fixed step that was cut goes on by a short
 * one to where it would have ended.
 */
#include <math.h>
#include <string.h>

#include "../step_limits.h"
#include "phases.h"

static const double ONE_INSTANT = 1e-9;     /* share of the time that has passed, within which an event acts at most twice */

int zd_run_acting(const zd_run *run) { return run->watch.calls - 1; }

void zd_run_leave_event(zd_run *run)
{
    zd_watch *watch = &run->watch;
    if (!watch->ended && !watch->next_action) return;
    watch->disarmed = watch->ended;
    watch->ended = watch->calls = watch->next_action = 0;
    memset(watch->acts, 0, watch->events->count * sizeof *watch->acts);
}

/* True if an event acts a third time at one instant. */
static int chatters(zd_run *run, int event)
{
    double *acted = run->watch.acted + 2 * event;
    const double t = run->stepper.t, longest = fmax(t - acted[1], acted[1] - acted[0]);
    acted[0] = acted[1];
    acted[1] = t;
    return run->watch.found[event] > 2 && longest < ONE_INSTANT * (t - run->settings.t0);
}

static void go_on(zd_run *run)
{
    zd_step_loop *loop = &run->loop;
    const double grid = loop->t_begin + (double)(loop->step - loop->steps_before) * run->settings.step;
    const double rounding = ZD_TIME_RESOLUTION * fmax(fabs(loop->t_begin), fabs(grid));
    loop->end = run->goal.end;
    if (!zd_is_adaptive(loop) && fmin(grid, loop->end) - run->stepper.t > rounding) loop->step--;
    zd_run_leave_event(run);
}

int zd_run_act(zd_run *run)
{
    zd_watch *watch = &run->watch;
    const zd_events *events = watch->events;
    if (!watch->ended) return ZD_DONE;
    const int own = run->phases && run->phases->own ? run->phases->own->count : run->phases ? 0 : events->count;
    for (int i = 0; !watch->next_action && i < own; i++)
        if (watch->acts[i] && chatters(run, i)) return ZD_CHATTERS;
    watch->calls = 0;
    while (watch->next_action < events->actions) {
        const zd_action *action = events->action + watch->next_action++;
        if (!watch->acts[action->event]) continue;
        if (action->input <= ZD_SWITCHES) {
            const int status = zd_run_switch(run, ZD_SWITCHES - action->input, action->value != 0 ? ZD_JOINED_HERE : ZD_RELEASED);
            return status ? status : ZD_PAUSED;     /* so that the caller sees each of several changes */
        }
        if (action->input == ZD_CHANGES_PHASE) {
            watch->next_action = events->actions;
            const int status = zd_phases_change(run, NULL, 0);
            if (status) return status;
            if (!zd_watch_ends(watch)) watch->ended = 0;        /* its function has a new value, from which it is armed */
            break;
        }
        if (action->input >= 0) run->settings.inputs->value[action->input] = action->value;
        else watch->calls = action->event + 1;
        if (watch->calls) return ZD_PAUSED;
    }
    if (watch->ended && zd_watch_ends(watch)) return ZD_DONE;
    go_on(run);
    return ZD_PAUSED;
}
