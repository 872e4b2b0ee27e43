/* Events: instants at which a function of the motion passes through zero.
 *
 * A step at whose ends the function has different signs brackets such an instant. The bracket is narrowed to the rounding of t by values
 * within the step, see between.c: of the dense output, with adaptive steps of a method that has one, or else of shorter steps. All these
 * points are corrected. So the ends of the step are corrected, too, before events are evaluated, even if the run itself continues without
 * correction (every k-th step only): otherwise the function would jump at the ends, and change its sign without a zero.
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
#include "events.h"

#include <math.h>

#include "../constraints/rank.h"
#include "../paths/choose.h"
#include "../point/quaternions.h"
#include "../step_limits.h"


zd_watch zd_watch_take(zd_arena *arena, const zd_events *events, zd_output *output)
{
    if (!events) return (zd_watch){.events = NULL};
    size_t count = (size_t)events->count;
    const zd_motion *motion = output->stepper->motion;
    return (zd_watch){
        .events = events,
        .output = output,
        .reader = zd_reader_take(arena, events, &motion->system, motion->rate.inputs, motion->point),
        .before = zd_take_doubles(arena, count),
        .now = zd_take_doubles(arena, count),
        .bracket = zd_take(arena, count * sizeof(zd_bracket)),
        .end = zd_state_take(arena, motion),
        .early = zd_state_take(arena, motion),
        .late = zd_state_take(arena, motion),
        .mixed = zd_state_take(arena, motion),
        .found = zd_take(arena, count * sizeof(int)),
    };
}

static int evaluate(zd_watch *self, int event, double t, const double *p, const double *v, double *value)
{
    const zd_events *events = self->events;
    const zd_system *system = &self->output->stepper->motion->system;
    const int reads = events->known && events->known[event].readings;
    int status = reads ? zd_read_event(&self->reader, system->data, event, t, p, v, value)
                       : events->evaluate(events->data, event, t, p, v, NULL, value);
    if (status) self->failed = event + 1;
    return status;
}

static int reads_accelerations(const zd_watch *self, int event)
{
    return zd_reads_accelerations(self->events, &self->output->stepper->motion->system, event);
}

static int evaluate_here(zd_watch *self, int event, double *value)
{
    const zd_stepper *stepper = self->output->stepper;
    const zd_point *point = stepper->motion->point;
    const int is_dynamic = reads_accelerations(self, event), status = is_dynamic ? zd_motion_accelerate(stepper->motion) : ZD_DONE;
    if (status) return status;
    if (is_dynamic) zd_rank_find_multipliers(point);
    return evaluate(self, event, stepper->t, point->p, point->v, value);
}

static int evaluate_all(zd_watch *self, double *values)
{
    int status = ZD_DONE;
    for (int i = 0; !status && i < self->events->count; i++) status = evaluate_here(self, i, &values[i]);
    return status;
}

int zd_watch_start(zd_watch *self)
{
    return evaluate_all(self, self->before);
}

/* True if the event occurs in the step. A function that is zero at the start of the step does not occur: it did before, or the run starts. */
static int happens(const zd_watch *self, int event)
{
    double before = self->before[event], now = self->now[event];
    int direction = self->events->direction[event];
    return (before < 0 && now >= 0 && direction >= 0) || (before > 0 && now <= 0 && direction <= 0);
}

static int correct(zd_stepper *stepper)
{
    return zd_path_end(zd_path_of_state(stepper->motion), stepper, stepper->t, 0, 1, 0);
}

/* Moves to a time within the step or at its ends, corrected. */
static int move(zd_watch *self, double t)
{
    zd_stepper *stepper = self->output->stepper;
    const zd_state *before = &self->output->before, *end = &self->end;
    if (t > before->t && t < end->t) return zd_output_go(self->output, t);
    int status = zd_stepper_return_to(stepper, t == end->t ? end : before);
    return status || t == end->t ? status : correct(stepper);
}

static zd_bracket bracket_of_step(const zd_watch *self, int event)
{
    const double t0 = self->output->before.t, t1 = self->end.t;
    return zd_bracket_of(t0, t1, self->before[event], self->now[event], ZD_TIME_RESOLUTION * fmax(fabs(t0), fabs(t1)));
}

static int locate(zd_watch *self, int event, zd_bracket *it)
{
    while (it->b - it->a > it->resolution) {
        double g, t = zd_bracket_choose(it);
        int status = move(self, t);
        if (!status) status = evaluate_here(self, event, &g);
        if (status) return status;
        zd_bracket_narrow(it, t, g);
    }
    return ZD_DONE;
}

/* Locates all events in the step, with brackets at infinity for those that do not occur; and the first terminal one, unless it is known. */
static int locate_all(zd_watch *self, double *end)
{
    const zd_events *events = self->events;
    const int known = self->ended;
    for (int i = 0; i < events->count; i++) {
        zd_bracket *it = &self->bracket[i];
        if (known == i + 1) continue;
        it->b = INFINITY;
        if (!happens(self, i)) continue;
        *it = bracket_of_step(self, i);
        int status = locate(self, i, it);
        if (status) return status;
        if (known || it->b >= *end || self->found[i] + 1 != events->terminal[i]) continue;
        *end = it->b;
        self->ended = i + 1;
    }
    return ZD_DONE;
}

/* Repeats the step up to a terminal event, located near its instant on the dense output, and locates the events before it. */
static int cut(zd_watch *self, double *end)
{
    zd_output *output = self->output;
    const int event = self->ended - 1;
    zd_bracket *it = &self->bracket[event];
    *it = zd_bracket_near(it->b, bracket_of_step(self, event));
    output->is_spread = 0;
    int status = locate(self, event, it);
    if (!status) status = zd_output_make_shorter(output, *end = it->b);
    if (!status) status = evaluate_all(self, self->now);
    if (status) return status;
    zd_stepper_keep_place(output->stepper, &self->end);
    status = zd_output_leave(output, 0);
    return status ? status : locate_all(self, end);
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
static int settle_between(zd_watch *self, int event, const zd_state **there)
{
    const zd_bracket *found = &self->bracket[event];
    zd_bracket it = zd_bracket_of(0, 1, found->ga, found->gb, ZD_TIME_RESOLUTION);
    while (it.gb != 0 && it.b - it.a > ZD_TIME_RESOLUTION) {
        double g, share = zd_bracket_choose(&it);
        const zd_state *mixed = mix(self, share);
        int status = evaluate(self, event, mixed->t, mixed->p, mixed->v, &g);
        if (status) return status;
        zd_bracket_narrow(&it, share, g);
    }
    *there = mix(self, it.b);
    return ZD_DONE;
}

/* *there <- the state at the event; the motion is moved to it or next to it. */
static int settle(zd_watch *self, int event, const zd_state **there)
{
    const zd_bracket *found = &self->bracket[event];
    const zd_stepper *stepper = self->output->stepper;
    const int is_mixed = (!self->output->is_spread || zd_bracket_leaps(found)) && !reads_accelerations(self, event);
    int status = is_mixed ? move(self, found->a) : ZD_DONE;
    if (is_mixed) zd_stepper_keep_place(stepper, &self->early);
    if (!status) status = move(self, found->b);
    zd_stepper_keep_place(stepper, &self->late);
    *there = &self->late;
    return status || !is_mixed ? status : settle_between(self, event, there);
}

static int report_one(zd_watch *self, int event)
{
    const zd_events *events = self->events;
    const zd_state *there;
    int status = settle(self, event, &there);
    if (!status) status = events->found(events->data, event, there->t, there->p, there->v);
    if (!status) self->found[event]++;
    return status || event != self->ended - 1 || there == &self->late ? status : zd_stepper_return_to(self->output->stepper, there);
}

/* Reports the events of the step, the terminal one last: the run ends at its state. */
static int report(zd_watch *self, double end)
{
    int status = ZD_DONE, last = self->ended - 1;
    for (int i = 0; !status && i < self->events->count; i++)
        if (i != last && self->bracket[i].b < INFINITY && self->bracket[i].b <= end) status = report_one(self, i);
    return status || !self->ended ? status : report_one(self, last);
}

/* Locates and reports the events of a step. Called at its corrected end; dense output belongs to the uncorrected step. */
static int find_all(zd_watch *self, double *end)
{
    zd_output *output = self->output;
    double first_end = INFINITY;
    zd_stepper_keep_place(output->stepper, &self->end);
    int status = output->is_away && zd_output_may_spread(output) ? zd_output_come_back(output) : ZD_DONE;
    if (!status && !output->is_away) status = zd_output_leave(output, 0);
    if (!status) status = locate_all(self, &first_end);
    if (!status && self->ended && output->is_spread) status = cut(self, &first_end);
    if (!status) status = report(self, first_end);
    if (self->ended) *end = first_end;
    return status;
}

/* *happening <- true if any event occurs between the previous evaluation and this one, at the corrected end of the step. */
static int find_happening(zd_watch *self, int *happening)
{
    int status = evaluate_all(self, self->now);
    for (int i = 0; !status && i < self->events->count; i++) *happening |= happens(self, i);
    return status;
}

int zd_watch_after(zd_watch *self, int corrected, double *end)
{
    zd_output *output = self->output;
    int happening = 0;
    if (!corrected) zd_output_leave_end(output);
    int status = corrected ? ZD_DONE : correct(output->stepper);
    if (!status) status = find_happening(self, &happening);
    if (!status && happening) status = find_all(self, end);
    if (!status && output->is_away && !self->ended) status = zd_output_come_back(output);
    output->is_away = 0;
    double *now = self->now;
    self->now = self->before;
    self->before = now;
    return status;
}
