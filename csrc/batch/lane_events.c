/* Events in lanes, as in output/events.c: a change of sign is located to the rounding of t, by dense output or by shorter steps; if an
 * event ends the run, the last step is repeated up to it. Each lane locates its own events, one after the other; the evaluations are
 * made in all lanes at once.
 */
#include <math.h>

#include "../step_limits.h"
#include "event_samples.h"
#include "group.h"


zd_lane_search zd_lane_search_take(zd_arena *arena, const zd_lanes *lanes)
{
    if (!lanes->watches) return (zd_lane_search){.ended = 0};
    const size_t events = (size_t)lanes->events, size = (size_t)lanes->size;
    return (zd_lane_search){
        .before = zd_take_doubles(arena, events),
        .now = zd_take_doubles(arena, events),
        .bracket = zd_take(arena, events * sizeof(zd_bracket)),
        .early = zd_take_doubles(arena, size),
        .mixed = zd_take_doubles(arena, size),
    };
}

/* ---- event functions ---- */

/* Value of an event function at the gathered state. If it fails, the run is repeated individually, which reports the failure. */
static double evaluate(zd_lane_group *self, int lane, int event, double t)
{
    double value = 0;
    if (zd_read_event(&self->reader, zd_lane_group_data(self, lane), event, t, self->p, self->v, &value)) self->lanes.leaves[lane] = 1;
    return value;
}

static void evaluate_all(zd_lane_group *self, int lane, double t, const double *y, double *values)
{
    zd_lane_group_gather(self, lane, y);
    for (int i = 0; i < self->lanes.events; i++) values[i] = evaluate(self, lane, i, t);
}

static int happens(const zd_lane_group *self, const zd_lane_search *search, int event)
{
    const double before = search->before[event], now = search->now[event];
    const int direction = self->batch->settings->events->direction[event];
    return (before < 0 && now >= 0 && direction >= 0) || (before > 0 && now <= 0 && direction <= 0);
}

/* ---- sequence of events in a lane ---- */

static double resolution_of(const zd_lanes *lanes, int lane)
{
    return ZD_TIME_RESOLUTION * fmax(fabs(lanes->t_before[lane]), fabs(lanes->t[lane]));
}

static int is_wide(const zd_lanes *lanes, int lane, const zd_bracket *bracket)
{
    return bracket->b - bracket->a > resolution_of(lanes, lane);
}

/* True if the event precedes the end of the run and is not the one that ends it, which is reported last. */
static int is_reported(const zd_lane_search *search, int event)
{
    const double b = search->bracket[event].b;
    return event != search->ended - 1 && b < INFINITY && b <= search->end;
}

/* Index of the next located event to be reported; the one that ends the run is last; -1: there are no more. */
static int next_reported(const zd_lane_group *self, const zd_lane_search *search, int event)
{
    const int last = search->ended - 1;
    if (event == last && last >= 0 && search->stage == ZD_GOES_BEHIND) return -1;
    for (int i = search->stage == ZD_LOCATES ? 0 : event + 1; i < self->lanes.events; i++)
        if (is_reported(search, i)) return i;
    return last;
}

/* True if the state at the event is interpolated between the states before and after. */
static int is_mixed(const zd_lane_group *self, const zd_lane_search *search)
{
    return !zd_lanes_may_spread(&self->lanes) || zd_bracket_leaps(&search->bracket[search->event]);
}

static void proceed_to_next(zd_lane_group *self, zd_lane_search *search)
{
    search->event = next_reported(self, search, search->event);
    search->stage = search->event < 0 ? ZD_FOUND_ALL : is_mixed(self, search) ? ZD_GOES_BEFORE : ZD_GOES_BEHIND;
}

/* Records a located event as the end of the run, if it is the last that its count admits. */
static void note_end(zd_lane_group *self, int lane)
{
    const zd_lane_run *run = &self->run_of[lane];
    zd_lane_search *search = &self->run_of[lane].search;
    const double b = search->bracket[search->event].b;
    const int64_t number = *zd_event_samples_count(self->batch, run->number, search->event) + 1;
    if (search->is_cut || b >= search->end || number != self->batch->settings->events->terminal[search->event]) return;
    search->end = b;
    search->ended = search->event + 1;
}

static zd_bracket bracket_of_step(const zd_lanes *lanes, const zd_lane_search *search, int lane, int event)
{
    return zd_bracket_of(lanes->t_before[lane], lanes->t[lane], search->before[event], search->now[event], resolution_of(lanes, lane));
}

/* Proceeds to the states, as all events are located. With dense output, the event that ends the run is located again by shorter steps,
 * near its time. */
static void go_to_states(zd_lane_group *self, int lane)
{
    zd_lane_search *search = &self->run_of[lane].search;
    if (!search->ended || search->is_cut || !zd_lanes_may_spread(&self->lanes)) {
        proceed_to_next(self, search);
        return;
    }
    search->event = search->ended - 1;
    zd_bracket *bracket = &search->bracket[search->event];
    *bracket = zd_bracket_near(bracket->b, bracket_of_step(&self->lanes, search, lane, search->event));
    search->stage = ZD_LOCATES_END;
}

/* Proceeds from this event to the first that has to be located; if there is none, to the states. */
static void locate_from(zd_lane_group *self, int lane, int event)
{
    const zd_lanes *lanes = &self->lanes;
    zd_lane_search *search = &self->run_of[lane].search;
    for (search->event = event; search->event < lanes->events; search->event++) {
        const int i = search->event;
        if (search->is_cut && i == search->ended - 1) continue;
        search->bracket[i].b = INFINITY;
        if (!happens(self, search, i)) continue;
        search->bracket[i] = bracket_of_step(lanes, search, lane, i);
        if (is_wide(lanes, lane, &search->bracket[i])) return;
        note_end(self, lane);
    }
    go_to_states(self, lane);
}

/* Locates events again in the step that was repeated up to the end of the run, by its dense output. */
static void locate_until_end(zd_lane_group *self, int lane)
{
    const zd_lanes *lanes = &self->lanes;
    zd_lane_search *search = &self->run_of[lane].search;
    search->end = lanes->t[lane];
    search->is_cut = 1;
    search->stage = ZD_LOCATES;
    evaluate_all(self, lane, lanes->t[lane], lanes->y, search->now);
    locate_from(self, lane, 0);
}

/* ---- states at events ---- */

static void mix(const zd_lane_group *self, int lane, double share, double *mixed)
{
    const zd_lanes *lanes = &self->lanes;
    const double *early = self->run_of[lane].search.early;
    for (int i = 0; i < lanes->size; i++) {
        const double late = zd_lane_number(lanes, lanes->y_sample, i, lane);
        mixed[i] = share == 1 ? late : early[i] + share * (late - early[i]);
    }
    for (int i = 0; i < lanes->nq; i++) self->p[i] = mixed[i];
    for (int i = 0; i < lanes->nv; i++) self->v[i] = mixed[lanes->nq + i];
}

/* Finds the state at the event and records it; the states before and after are known, the latter in y_sample. */
static void find_state(zd_lane_group *self, int lane)
{
    zd_lane_run *run = &self->run_of[lane];
    const zd_bracket *located = &run->search.bracket[run->search.event];
    zd_bracket it = zd_bracket_of(0, 1, located->ga, located->gb, ZD_TIME_RESOLUTION);
    while (is_mixed(self, &run->search) && it.gb != 0 && it.b - it.a > ZD_TIME_RESOLUTION) {
        const double share = zd_bracket_choose(&it);
        mix(self, lane, share, run->search.mixed);
        zd_bracket_narrow(&it, share, evaluate(self, lane, run->search.event, located->b));
    }
    mix(self, lane, it.b, run->search.mixed);
    zd_event_samples found = {self->batch, run->number};
    zd_event_samples_add(&found, run->search.event, located->b, self->p, self->v);
}

void zd_lane_group_go_to_end(zd_lane_group *self, int lane)
{
    zd_lanes *lanes = &self->lanes;
    zd_lane_search *search = &self->run_of[lane].search;
    for (int i = 0; i < lanes->size; i++) zd_lane_set(lanes, lanes->y, i, lane, search->mixed[i]);
    lanes->t[lane] = search->end;
    search->is_at_end = 1;
}

/* ---- all lanes ---- */

/* Begins the location of events in the step that a lane has just made. */
static void begin(zd_lane_group *self, int lane)
{
    const zd_lanes *lanes = &self->lanes;
    zd_lane_search *search = &self->run_of[lane].search;
    double *now = search->before;
    search->before = search->now;
    search->now = now;
    if (search->number_of_now != lanes->number[lane] - 1) evaluate_all(self, lane, lanes->t_before[lane], lanes->y0, search->before);
    evaluate_all(self, lane, lanes->t[lane], lanes->y, search->now);
    search->number_of_now = lanes->number[lane];
    search->stage = ZD_LOCATES;
    search->end = INFINITY;
    if (self->lanes.leaves[lane] == 0) locate_from(self, lane, 0);
}

static double time_requested(const zd_lane_search *search)
{
    const zd_bracket *bracket = &search->bracket[search->event];
    const int locates = search->stage == ZD_LOCATES || search->stage == ZD_LOCATES_END;
    return locates ? zd_bracket_choose(bracket) : search->stage == ZD_GOES_BEFORE ? bracket->a : bracket->b;
}

/* Continues the location with the state at the time that the lane requested. */
static void resume(zd_lane_group *self, int lane)
{
    const zd_lanes *lanes = &self->lanes;
    zd_lane_search *search = &self->run_of[lane].search;
    zd_bracket *bracket = &search->bracket[search->event];
    switch (search->stage) {
    case ZD_LOCATES:
    case ZD_LOCATES_END:
        zd_lane_group_gather(self, lane, lanes->y_sample);
        zd_bracket_narrow(bracket, lanes->t_sample[lane], evaluate(self, lane, search->event, lanes->t_sample[lane]));
        if (is_wide(lanes, lane, bracket)) return;
        if (search->stage == ZD_LOCATES_END) {
            search->stage = ZD_CUTS;
            return;
        }
        note_end(self, lane);
        locate_from(self, lane, search->event + 1);
        return;
    case ZD_CUTS: locate_until_end(self, lane); return;
    case ZD_GOES_BEFORE:
        for (int i = 0; i < lanes->size; i++) search->early[i] = zd_lane_number(lanes, lanes->y_sample, i, lane);
        search->stage = ZD_GOES_BEHIND;
        return;
    case ZD_GOES_BEHIND:
        find_state(self, lane);
        proceed_to_next(self, search);
        return;
    case ZD_FOUND_ALL: return;
    }
}

/* Evaluation of states within a step: as dense output allows, by a shorter step, or by repeating the step. */
enum { BETWEEN, BY_SHORTER_STEP, BY_CUT, WAYS };

static int way_of(const zd_lane_search *search)
{
    return search->stage == ZD_LOCATES_END ? BY_SHORTER_STEP : search->stage == ZD_CUTS ? BY_CUT : BETWEEN;
}

/* Requests a state of the lane at a time within the step, if its search needs one that is computed by `way`. Returns 1 if it does, 0
 * otherwise. */
static int request(zd_lane_group *self, int lane, int way)
{
    zd_lanes *lanes = &self->lanes;
    const zd_lane_run *run = &self->run_of[lane];
    const int is_checking = run->number >= 0 && lanes->leaves[lane] == 0 && run->search.stage != ZD_FOUND_ALL;
    const int requests = is_checking && way_of(&run->search) == way;
    lanes->is_wanted[lane] = requests;
    lanes->t_sample[lane] = requests ? time_requested(&run->search) : lanes->t[lane];
    return requests;
}

/* Serves all requests by this way; returns 0 if there were none. */
static int go_all(zd_lane_group *self, int way)
{
    zd_lanes *lanes = &self->lanes;
    int any = 0;
    for (int lane = 0; lane < lanes->lanes; lane++) any |= request(self, lane, way);
    if (!any) return 0;
    if (way == BETWEEN) self->functions->move_between(lanes, 0);
    else if (way == BY_SHORTER_STEP) self->functions->substep(lanes);
    else self->functions->cut(lanes);
    for (int lane = 0; lane < lanes->lanes; lane++)
        if (lanes->is_wanted[lane] != 0 && lanes->leaves[lane] == 0) resume(self, lane);
    return 1;
}

void zd_lane_group_locate(zd_lane_group *self)
{
    zd_lanes *lanes = &self->lanes;
    for (int lane = 0; lane < lanes->lanes; lane++) {
        const int has = self->run_of[lane].number >= 0 && lanes->has_event[lane] != 0 && lanes->leaves[lane] == 0;
        self->run_of[lane].search.stage = ZD_FOUND_ALL;
        lanes->has_event[lane] = 0;
        if (has) begin(self, lane);
    }
    for (int any = 1; any;) {
        any = 0;
        for (int way = 0; way < WAYS; way++) any |= go_all(self, way);
    }
}
