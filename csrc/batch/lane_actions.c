/* Actions at events in lanes, as in run/act.c: inputs are set in the data of a lane, which goes on from the instant of the event. */
#include <math.h>

#include "../step_limits.h"
#include "group.h"

static const double FREQUENT = 1e-9;    /* share of the time that has passed: shorter steps between two events are made individually */

int64_t zd_lane_last_of(const zd_lane_group *self, const zd_lane_run *run, int event)
{
    const zd_events *events = self->batch->settings->events;
    return zd_acts(events, event) ? *zd_event_samples_count(self->batch, run->number, event) + 1 : events->terminal[event];
}

/* Writes the inputs of an action to the gathered data of a lane. Places are those of the common system. */
static void set_input(const zd_lane_group *self, const zd_action *action)
{
    const zd_inputs *inputs = self->batch->settings->inputs;
    const zd_input_slot *end = inputs->place + inputs->places;
    for (const zd_input_slot *slot = inputs->place; slot < end; slot++)
        if (slot->input == action->input) self->numbers[slot->place - (const double *)self->batch->system->data] = action->value;
}

static void set_inputs(zd_lane_group *self, int lane)
{
    const zd_settings *settings = self->batch->settings;
    zd_lane_group_data(self, lane);
    for (const zd_action *next = settings->events->action; next < settings->events->action + settings->events->actions; next++)
        if (self->run_of[lane].search.acts[next->event]) set_input(self, next);
    for (int i = 0; i < settings->inputs->derivations; i++) settings->inputs->derive[i](self->numbers);
    for (int64_t i = 0; i < self->batch->doubles; i++) zd_lane_set(&self->lanes, self->lanes.data, i, lane, self->numbers[i]);
}

/* The next step begins here, to the end of a fixed one; event functions are known at its start as by zd_watch_arm(). */
static void go_on(zd_lane_group *self, int lane)
{
    zd_lanes *lanes = &self->lanes;
    zd_lane_search *search = &self->run_of[lane].search;
    zd_watch *watch = &self->run->watch;
    const double t = lanes->t[lane], grid = lanes->t0 + lanes->number[lane] * lanes->step;
    const double rounding = ZD_TIME_RESOLUTION * fmax(fabs(lanes->t0), fabs(grid));
    if (lanes->is_fixed && fmin(grid, lanes->end) - t > rounding) lanes->number[lane]--;
    lanes->order[lane] = NAN;       /* accelerations are evaluated anew */
    self->run_of[lane].number_of_C = -1;
    search->number_of_now = lanes->number[lane];
    zd_lane_group_evaluate_all(self, lane, t, lanes->y, search->now);
    for (int i = 0; i < search->occurrences; i++) {
        const zd_bracket *it = &search->occurrence[i].bracket;
        if (zd_is_same_instant(it->b, t, it->resolution)) search->now[search->occurrence[i].event] = 0;
    }
    zd_lane_group_stand(self, lane, t, lanes->y);
    self->run->stepper.t = t;
    watch->disarmed = search->ended;
    if (zd_watch_arm(watch) || t - lanes->t_before[lane] < FREQUENT * (t - lanes->t0)) lanes->leaves[lane] = 1;
    search->now[search->ended - 1] = watch->before[search->ended - 1];
    search->ended = search->is_cut = search->is_at_end = 0;
}

void zd_lane_group_act(zd_lane_group *self)
{
    int any = 0;
    for (int lane = 0; lane < self->lanes.lanes; lane++) {
        if (!zd_lane_has_run(self, lane) || !self->run_of[lane].search.ended) continue;
        set_inputs(self, lane);
        go_on(self, lane);
        any = 1;
    }
    if (any) self->functions->choose(&self->lanes);
}
