/* Events in lanes, as in output/events.c: changes of sign between samples are located to the rounding of t, by dense output or by
 * shorter steps; if an event ends the run, the last step is repeated up to it. Each lane locates its own events, one after the other;
 * the evaluations are made in all lanes at once.
 */
#include <math.h>
#include <string.h>

#include "../linalg/small.h"
#include "../step_limits.h"
#include "batch.h"
#include "group.h"

/* ---- samples and pairs ---- */

static void locate_from(zd_lane_group *self, int lane);

/* Proceeds from this event to the first whose pairs need a value; if there is none, to the location of events. */
static void find_pairs_from(zd_lane_group *self, int lane, int event, int is_new)
{
    zd_lane_search *search = &self->run_of[lane].search;
    for (search->event = event; search->event < self->lanes.events; search->event++, is_new = 1) {
        zd_zeros *zeros = &search->zeros[search->event];
        if (is_new) zd_zeros_begin(zeros);
        if (zeros->count > 2 && zd_zeros_next(zeros)) return;
    }
    search->stage = ZD_LOCATES;
    search->event = search->number = search->occurrences = 0;
    search->point = 1;
    locate_from(self, lane);
}

static void sample_step(zd_lane_group *self, int lane)
{
    zd_lane_search *search = &self->run_of[lane].search;
    search->stage = ZD_SAMPLES_STEP;
    search->sample = 1;
    zd_lane_group_span(self, lane);
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

/* Index of the next located occurrence to be reported, after this one; the one that ends the run is last; -1 if all are reported. */
static int next_reported(const zd_lane_search *search, int index)
{
    if (index >= 0 && index == search->last) return -1;
    for (int i = index + 1; i < search->occurrences; i++)
        if (i != search->last && search->occurrence[i].bracket.b <= search->end) return i;
    return search->last;
}

/* True if the state at the event is interpolated between the states before and after. */
static int is_mixed(const zd_lane_group *self, const zd_lane_search *search)
{
    return !zd_lanes_have_dense_output(&self->lanes) || zd_bracket_leaps(&search->occurrence[search->index].bracket);
}

static void proceed_to_next(zd_lane_group *self, zd_lane_search *search, int index)
{
    search->index = next_reported(search, index);
    search->stage = search->index < 0 ? ZD_FOUND_ALL : is_mixed(self, search) ? ZD_GOES_BEFORE : ZD_GOES_BEHIND;
}

/* Records a located event as the end of the run, if it is the last that its count admits; proceeds to the next point. */
static void note_located(zd_lane_group *self, int lane)
{
    zd_lane_run *run = &self->run_of[lane];
    zd_lane_search *search = &run->search;
    double *b = &search->occurrence[search->occurrences - 1].bracket.b;
    const int64_t number = *zd_event_samples_count(self->batch, run->number, search->event) + ++search->number;
    const int is_last = search->is_cut ? zd_acts(self->batch->settings->events, search->event)
                                       : number == zd_lane_last_of(self, run, search->event);
    search->point++;
    if (is_last && zd_is_same_instant(*b, search->end, resolution_of(&self->lanes, lane))) *b = search->end;
    if (search->is_cut || !is_last || *b >= search->end) return;
    search->end = *b, search->ended = search->event + 1, search->last = search->occurrences - 1;
}

static zd_bracket bracket_of(const zd_lanes *lanes, const zd_lane_search *search, int lane, int first, int last)
{
    return zd_zeros_bracket(&search->zeros[search->event], first, last, resolution_of(lanes, lane));
}

/* Proceeds to the states, as all events are located. With dense output, the event that ends the run is located again by shorter steps,
 * near its time. */
static void go_to_states(zd_lane_group *self, int lane)
{
    zd_lane_search *search = &self->run_of[lane].search;
    if (search->is_cut) {
        search->last = search->occurrences++;
        search->occurrence[search->last] = search->cut;
    } else if (search->last >= 0 && zd_lanes_have_dense_output(&self->lanes)) {
        int first, last;
        search->cut = search->occurrence[search->last];
        search->event = search->cut.event;
        zd_zeros_widen(&search->zeros[search->event], search->cut.point, &first, &last);
        search->cut.bracket = zd_bracket_near(search->cut.bracket.b, bracket_of(&self->lanes, search, lane, first, last));
        search->stage = ZD_LOCATES_END;
        return;
    }
    proceed_to_next(self, search, -1);
}

/* Number of occurrences of the event that may be located in the step: of the one that ends the run, those before. */
static int64_t max_samples_of(const zd_lane_group *self, const zd_lane_run *run)
{
    const zd_lane_search *search = &run->search;
    if (!search->is_cut || search->event != search->cut.event) return ZD_MAX_POINTS;
    return zd_lane_last_of(self, run, search->event) - 1 - *zd_event_samples_count(self->batch, run->number, search->event);
}

/* Proceeds to the next change of sign of the event that has to be located; returns 0 if there is none. */
static int find_change(const zd_lane_group *self, zd_lane_run *run)
{
    zd_lane_search *search = &run->search;
    const zd_zeros *zeros = &search->zeros[search->event];
    const int direction = self->run->settings.events->direction[search->event];
    const double *g = zeros->g;
    while (search->point < zeros->count && !zd_passes_zero(g[search->point - 1], g[search->point], direction)) search->point++;
    return search->point < zeros->count && search->number < max_samples_of(self, run);
}

/* Proceeds from this event and point to the first that has to be located; if there is none, to the states. */
static void locate_from(zd_lane_group *self, int lane)
{
    const zd_lanes *lanes = &self->lanes;
    zd_lane_search *search = &self->run_of[lane].search;
    for (; search->event < lanes->events; search->event++, search->point = 1, search->number = 0) {
        while (find_change(self, &self->run_of[lane])) {
            if (zd_lane_contact_leaves(self, lane)) return;
            const int k = search->point;
            zd_occurrence *it = &search->occurrence[search->occurrences++];
            *it = (zd_occurrence){search->event, k, bracket_of(lanes, search, lane, k - 1, k)};
            if (is_wide(lanes, lane, &it->bracket)) return;
            note_located(self, lane);
        }
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
    search->last = -1;
    zd_lane_group_evaluate_all(self, lane, lanes->t[lane], lanes->y, search->now);
    sample_step(self, lane);
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
    zd_copy(lanes->nq, mixed, self->p);
    zd_copy(lanes->nv, mixed + lanes->nq, self->v);
}

/* Finds the state at the event and records it; the states before and after are known, the latter in y_sample. */
static void find_state(zd_lane_group *self, int lane)
{
    zd_lane_run *run = &self->run_of[lane];
    const zd_occurrence *occurrence = &run->search.occurrence[run->search.index];
    const zd_bracket *located = &occurrence->bracket;
    zd_bracket it = zd_bracket_of(0, 1, located->ga, located->gb, ZD_TIME_RESOLUTION);
    while (is_mixed(self, &run->search) && it.gb != 0 && it.b - it.a > ZD_TIME_RESOLUTION) {
        const double share = zd_bracket_choose(&it);
        mix(self, lane, share, run->search.mixed);
        zd_bracket_narrow(&it, share, zd_lane_group_evaluate(self, lane, occurrence->event, located->b));
    }
    mix(self, lane, it.b, run->search.mixed);
    zd_event_samples found = {self->batch, run->number};
    zd_event_samples_add(&found, occurrence->event, located->b, self->p, self->v);
    const zd_events *events = self->batch->settings->events;
    const int is_last = *zd_event_samples_count(self->batch, run->number, occurrence->event) == events->terminal[occurrence->event];
    run->search.acts[occurrence->event] = zd_acts(events, occurrence->event);
    if (is_last) run->search.ended = occurrence->event + 1;
    run->search.goes_on &= !is_last;
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
    const int is_known = search->number_of_now == lanes->number[lane] - 1;
    if (!is_known) zd_lane_group_evaluate_all(self, lane, lanes->t_before[lane], lanes->y0, search->before);
    zd_lane_group_evaluate_all(self, lane, lanes->t[lane], lanes->y, search->now);
    search->number_of_now = lanes->number[lane];
    search->end = INFINITY;
    search->last = -1;
    search->goes_on = 1;
    memset(search->acts, 0, lanes->events * sizeof *search->acts);
    if (self->lanes.leaves[lane] != 0) return;
    sample_step(self, lane);
    if (lanes->is_fixed && !zd_lane_group_predict(self, lane)) find_pairs_from(self, lane, 0, 1);
}

static double time_requested(const zd_lanes *lanes, int lane, const zd_lane_search *search)
{
    const double t0 = lanes->t_before[lane];
    switch (search->stage) {
    case ZD_SAMPLES_STEP: return t0 + zd_sample_share(search->sample) * (lanes->t[lane] - t0);
    case ZD_FINDS_PAIRS: return search->zeros[search->event].next;
    case ZD_LOCATES: return zd_bracket_choose(&search->occurrence[search->occurrences - 1].bracket);
    case ZD_LOCATES_END: return zd_bracket_choose(&search->cut.bracket);
    case ZD_CUTS: return search->cut.bracket.b;
    case ZD_GOES_BEFORE: return search->occurrence[search->index].bracket.a;
    case ZD_GOES_BEHIND: return search->occurrence[search->index].bracket.b;
    case ZD_FOUND_ALL: break;
    }
    return lanes->t[lane];
}

/* Continues a bracket with the gathered state; returns 1 when it is located. */
static int narrow(zd_lane_group *self, int lane, zd_bracket *bracket)
{
    const double t = self->lanes.t_sample[lane];
    zd_bracket_narrow(bracket, t, zd_lane_group_evaluate(self, lane, self->run_of[lane].search.event, t));
    return !is_wide(&self->lanes, lane, bracket);
}

/* Continues the samples and the search for pairs with the gathered state. */
static void resume_samples(zd_lane_group *self, int lane)
{
    zd_lane_search *search = &self->run_of[lane].search;
    const double t = self->lanes.t_sample[lane];
    if (search->stage == ZD_FINDS_PAIRS) {
        const double g = zd_lane_group_evaluate(self, lane, search->event, t);
        zd_zeros_narrow(&search->zeros[search->event], g, zd_lane_group_rounding(self, lane, search->event, t, g));
        find_pairs_from(self, lane, search->event, 0);
        return;
    }
    zd_lane_group_add_sample(self, lane, t);
    if (search->sample++ < ZD_SAMPLES) return;
    search->stage = ZD_FINDS_PAIRS;
    find_pairs_from(self, lane, 0, 1);
}

/* Continues the location with the state at the time that the lane requested. */
static void resume(zd_lane_group *self, int lane)
{
    const zd_lanes *lanes = &self->lanes;
    zd_lane_search *search = &self->run_of[lane].search;
    zd_lane_group_gather(self, lane, lanes->y_sample);
    switch (search->stage) {
    case ZD_SAMPLES_STEP:
    case ZD_FINDS_PAIRS: resume_samples(self, lane); return;
    case ZD_LOCATES:
        if (!narrow(self, lane, &search->occurrence[search->occurrences - 1].bracket)) return;
        note_located(self, lane);
        locate_from(self, lane);
        return;
    case ZD_LOCATES_END:
        if (narrow(self, lane, &search->cut.bracket)) search->stage = ZD_CUTS;
        return;
    case ZD_CUTS: locate_until_end(self, lane); return;
    case ZD_GOES_BEFORE:
        for (int i = 0; i < lanes->size; i++) search->early[i] = zd_lane_number(lanes, lanes->y_sample, i, lane);
        search->stage = ZD_GOES_BEHIND;
        return;
    case ZD_GOES_BEHIND:
        find_state(self, lane);
        proceed_to_next(self, search, search->index);
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
    lanes->t_sample[lane] = requests ? time_requested(lanes, lane, &run->search) : lanes->t[lane];
    return requests;
}

/* Serves all requests by this way; returns 0 if there were none. */
static int go_all(zd_lane_group *self, int way)
{
    zd_lanes *lanes = &self->lanes;
    int any = 0;
    for (int lane = 0; lane < lanes->lanes; lane++) any |= request(self, lane, way);
    if (!any) return 0;
    if (way == BETWEEN) self->functions->move_within(lanes, 0);
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
        if (has && !zd_lane_contacts_stay_open(self, lane)) begin(self, lane);
    }
    for (int any = 1; any;) {
        any = 0;
        for (int way = 0; way < WAYS; way++) any |= go_all(self, way);
    }
}
