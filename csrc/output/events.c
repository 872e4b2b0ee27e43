/* Events: instants at which a function of the motion passes through zero.
 *
 * Two points of a step at which the function has different signs bracket such an instant, see step_samples.c. The bracket is narrowed to
 * the rounding of t by values within the step, see within_step.c: of the dense output, with adaptive steps of a method that has one, or else
 * of shorter steps. All these points are corrected. So the ends of the step are corrected, too, before events are evaluated, even if the
 * run itself continues without correction (every k-th step only): otherwise the function would jump at the ends, and change its sign
 * without a zero.
 *
 * A terminal event ends the run with a step to its instant. Shorter steps locate the event again, near the instant given by the dense
 * output, and the last of them is the last step of the run; other events in it are located on its own dense output.
 *
 * Remaining jumps (corrections stop within their tolerance, energy corrections are left out near rest) and the rounding of t between
 * shorter steps are removed at last: the states on both sides of the instant are interpolated linearly to the zero of the function. The
 * end of the bracket after the event is reported, so that a run that starts there does not find it again.
 *
 * Reactions and accelerations that an event reads are those of the state at which it is evaluated, with the inputs of its step. They are not
 * interpolated: the state after the event is reported as it is.
 */
#include "watch.h"

#include <math.h>

#include "../paths/path.h"
#include "../point/point.h"
#include "../step_limits.h"

/* Rates at one end of a step that is not sampled by dense output or a series. */
static zd_end_rates create_end_rates(zd_arena *arena, const zd_output *output)
{
    const zd_system *system = &output->stepper->motion->system;
    if (zd_is_adaptive(output->loop) || output->stepper->integrator->takes_series) return (zd_end_rates){0};
    return (zd_end_rates){zd_arena_doubles(arena, system->nq), zd_arena_doubles(arena, system->nv), 0};
}

static int is_of_group(const zd_events *events, int event)
{
    const zd_event *known = events->known ? events->known + event : NULL;
    return known && known->readings && known->reading->what == ZD_READS_GROUP;
}

zd_watch zd_watch_create(zd_arena *arena, const zd_events *events, zd_output *output)
{
    if (!events) return (zd_watch){.events = NULL};
    size_t count = events->count;
    int groups = 0;
    for (int i = 0; i < events->count; i++) groups += is_of_group(events, i);
    const zd_motion *motion = output->stepper->motion;
    return (zd_watch){
        .events = events,
        .output = output,
        .reader = zd_reader_create(arena, events, &motion->system, motion->rate.inputs, motion->point),
        .before = zd_arena_doubles(arena, count),
        .now = zd_arena_doubles(arena, count),
        .zeros = zd_arena_bytes(arena, count * sizeof(zd_zeros)),
        .occurrence = zd_arena_bytes(arena, count * ZD_MAX_POINTS * sizeof(zd_occurrence)),
        .at_start = create_end_rates(arena, output),
        .at_end = create_end_rates(arena, output),
        .gaps = {zd_gaps_create(arena, &motion->system, groups), zd_gaps_create(arena, &motion->system, groups)},
        .end = zd_state_create(arena, motion),
        .early = zd_state_create(arena, motion),
        .late = zd_state_create(arena, motion),
        .mixed = zd_state_create(arena, motion),
        .found = zd_arena_ints(arena, count),
        .acts = zd_arena_ints(arena, count),
        .acted = zd_arena_doubles(arena, 2 * count),
    };
}

int zd_watch_start(zd_watch *self)
{
    zd_phase_system *phase = self->output->stepper->motion->point->phase;
    if (phase) zd_phase_forget(phase);
    self->gaps[self->end_gaps].t = NAN;
    return zd_watch_evaluate_all(self, self->before);
}

static zd_bracket bracket_of(const zd_watch *self, int event, int first, int last)
{
    const double t0 = self->output->before.t, resolution = ZD_TIME_RESOLUTION * fmax(fabs(t0), fabs(self->end.t));
    return zd_zeros_bracket(&self->zeros[event], first, last, resolution);
}

/* The widest bracket of an occurrence by points of the same signs, near the instant that is known. */
static zd_bracket widened(const zd_watch *self, const zd_occurrence *of)
{
    int first, last;
    zd_zeros_widen(&self->zeros[of->event], of->point, &first, &last);
    return zd_bracket_near(of->bracket.b, bracket_of(self, of->event, first, last));
}

/* Moves to a time within the step; a state to which the search has made a shorter step is not computed again. */
static int move(zd_watch *self, double t)
{
    const zd_state *saved = t == self->early.t ? &self->early : t == self->late.t ? &self->late : NULL;
    return saved && !self->output->is_prepared ? zd_stepper_return_to(self->output->stepper, saved) : zd_watch_move(self, t);
}

static int locate(zd_watch *self, zd_occurrence *occurrence)
{
    zd_bracket *it = &occurrence->bracket;
    while (it->b - it->a > it->resolution) {
        double g, t = zd_bracket_choose(it);
        int status = move(self, t);
        if (!status) status = zd_watch_evaluate(self, occurrence->event, &g);
        if (status) return status;
        zd_bracket_narrow(it, t, g);
        if (!self->output->is_prepared) zd_stepper_save_state(self->output->stepper, it->a == t ? &self->early : &self->late);
    }
    return ZD_DONE;
}

/* Locates at most this number of occurrences of an event in the step. The first terminal one before `end` becomes the last of the run. */
static int locate_event(zd_watch *self, int event, int most, double *end)
{
    const zd_events *events = self->events;
    const zd_zeros *zeros = &self->zeros[event];
    for (int k = 1, number = 0; k < zeros->count && number < most; k++) {
        if (!zd_passes_zero(zeros->g[k - 1], zeros->g[k], events->direction[event])) continue;
        zd_occurrence *it = &self->occurrence[self->occurrences++];
        *it = (zd_occurrence){event, k, bracket_of(self, event, k - 1, k)};
        /* Contacts with one freedom change at one instant. */
        if (is_of_group(events, event) && it->bracket.a < *end && *end < it->bracket.b) it->bracket = zd_bracket_near(*end, it->bracket);
        int status = locate(self, it);
        if (status) return status;
        const int is_last = self->found[event] + ++number == events->terminal[event] || zd_acts(events, event);
        if (is_last && zd_is_same_instant(it->bracket.b, *end, it->bracket.resolution)) it->bracket.b = *end;   /* in their order */
        if (!is_last || it->bracket.b >= *end) continue;
        *end = it->bracket.b;
        self->ended = event + 1;
        self->last = self->occurrences - 1;
    }
    return ZD_DONE;
}

static int locate_all(zd_watch *self, double *end)
{
    int status = ZD_DONE;
    self->occurrences = 0;
    self->last = -1;
    for (int i = 0; !status && i < self->events->count; i++) status = locate_event(self, i, ZD_MAX_POINTS, end);
    return status;
}

/* Repeats the step up to a terminal event, located near its instant on the dense output, and locates the events before it. */
static int cut(zd_watch *self, double *end)
{
    zd_output *output = self->output;
    zd_occurrence last = self->occurrence[self->last];
    const int earlier = zd_acts(self->events, last.event) ? 0 : self->events->terminal[last.event] - self->found[last.event] - 1;
    last.bracket = widened(self, &last);
    output->is_prepared = 0;
    int status = locate(self, &last);
    if (!status) status = zd_output_make_shorter(output, last.bracket.b);
    if (!status) status = zd_watch_evaluate_all(self, self->now);
    if (status) return status;
    zd_stepper_save_state(output->stepper, &self->end);
    zd_watch_span(self);
    status = zd_output_leave(output);
    if (!status) status = zd_watch_sample(self);
    *end = -INFINITY;       /* no other event is the last */
    self->occurrences = 0;
    for (int i = 0; !status && i < self->events->count; i++)
        status = locate_event(self, i, i == last.event ? earlier : ZD_MAX_POINTS, end);
    *end = last.bracket.b;
    for (zd_occurrence *it = self->occurrence; it < self->occurrence + self->occurrences; it++)
        if (zd_acts(self->events, it->event) && zd_is_same_instant(it->bracket.b, *end, it->bracket.resolution)) it->bracket.b = *end;
    self->last = self->occurrences++;
    self->occurrence[self->last] = last;
    return status;
}

static void mix_doubles(int n, const double *a, const double *b, double share, double *mixed)
{
    for (int i = 0; i < n; i++) mixed[i] = a[i] + share * (b[i] - a[i]);
}

/* Linear interpolation of the states on both sides of an event, at the time of the later one. */
static const zd_state *mix(zd_watch *self, double share)
{
    const zd_motion *motion = self->output->stepper->motion;
    const zd_state *early = &self->early, *late = &self->late;
    zd_state *mixed = &self->mixed;
    if (share == 1) return late;
    mixed->t = late->t;
    mix_doubles(motion->system.nq, early->p, late->p, share, mixed->p);
    mix_doubles(motion->system.nv, early->v, late->v, share, mixed->v);
    mix_doubles(motion->rate.size - motion->formulation_size, early->extra, late->extra, share, mixed->extra);
    zd_quaternions_normalise(&motion->system, mixed->p);
    return mixed;
}

/* *there <- the interpolated state at which the event function is zero. */
static int interpolate_event(zd_watch *self, const zd_occurrence *found, const zd_state **there)
{
    zd_bracket it = zd_bracket_of(0, 1, found->bracket.ga, found->bracket.gb, ZD_TIME_RESOLUTION);
    while (it.gb != 0 && it.b - it.a > ZD_TIME_RESOLUTION) {
        double g, share = zd_bracket_choose(&it);
        int status = zd_watch_evaluate_at(self, found->event, mix(self, share), &g);
        if (status) return status;
        zd_bracket_narrow(&it, share, g);
    }
    *there = mix(self, it.b);
    return ZD_DONE;
}

/* *there <- the state at the event; the motion is moved to it or next to it. */
static int move_to_event(zd_watch *self, const zd_occurrence *found, const zd_state **there)
{
    const zd_stepper *stepper = self->output->stepper;
    const int jumps = !self->output->is_prepared || zd_bracket_leaps(&found->bracket);
    const int is_mixed = jumps && !zd_watch_reads_accelerations(self, found->event);
    int status = is_mixed ? move(self, found->bracket.a) : ZD_DONE;
    if (is_mixed) zd_stepper_save_state(stepper, &self->early);
    if (!status) status = move(self, found->bracket.b);
    zd_stepper_save_state(stepper, &self->late);
    *there = &self->late;
    return status || !is_mixed ? status : interpolate_event(self, found, there);
}

static int report_one(zd_watch *self, int index)
{
    const zd_events *events = self->events;
    const zd_occurrence *found = &self->occurrence[index];
    const zd_state *there;
    int status = move_to_event(self, found, &there);
    if (!status && events->found) status = events->found(events->data, found->event, there->t, there->p, there->v);
    if (status) return status;
    self->acts[found->event] = zd_acts(events, found->event);
    if (++self->found[found->event] == events->terminal[found->event]) self->ended = found->event + 1;
    return index != self->last || there == &self->late ? ZD_DONE : zd_stepper_return_to(self->output->stepper, there);
}

/* Reports the events of the step, the terminal one last: the run ends at its state. */
static int report(zd_watch *self, double end)
{
    int status = ZD_DONE;
    for (int i = 0; !status && i < self->occurrences; i++)
        if (i != self->last && self->occurrence[i].bracket.b <= end) status = report_one(self, i);
    return status || self->last < 0 ? status : report_one(self, self->last);
}

/* Values from which the next step begins after an event: those of events that occurred at the same instant are zero. */
static int restart(zd_watch *self, double end, int is_known)
{
    const int status = is_known ? ZD_DONE : zd_watch_evaluate_all(self, self->now);
    for (int i = 0; i < self->occurrences; i++) {
        const zd_bracket *it = &self->occurrence[i].bracket;
        if (zd_is_same_instant(it->b, end, it->resolution)) self->now[self->occurrence[i].event] = 0;
    }
    return status;
}

/* Locates and reports the events of a step. */
static int find_all(zd_watch *self, double *end)
{
    zd_output *output = self->output;
    double first_end = INFINITY;
    self->early.t = self->late.t = NAN;
    int status = zd_watch_leave(self);
    if (!status) status = zd_watch_sample(self);
    if (!status) status = locate_all(self, &first_end);
    const int is_cut = self->ended && output->is_prepared;
    if (!status && is_cut) status = cut(self, &first_end);
    if (!status) status = report(self, first_end);
    if (!status && self->ended) status = restart(self, first_end, is_cut);
    if (self->ended) *end = first_end;
    return status;
}

int zd_watch_after(zd_watch *self, int corrected, double *end)
{
    zd_output *output = self->output;
    int occurs = 0;
    if (!corrected) zd_output_save_end(output);
    int status = corrected ? ZD_DONE : zd_watch_correct(output->stepper);
    zd_stepper_save_state(output->stepper, &self->end);
    if (!status) status = zd_watch_find_gaps(self);
    if (!status) status = zd_watch_evaluate_all(self, self->now);
    if (!status) status = zd_watch_predict(self, &occurs);
    if (!status && occurs) status = find_all(self, end);
    if (!status && output->is_within && !self->ended) status = zd_output_return_to_end(output);
    output->is_within = 0;
    zd_copy_all(self->events->count, self->now, self->before);
    return status;
}
