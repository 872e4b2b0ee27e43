/* Events: instants at which a function of the motion passes through zero.
 *
 * A step at whose ends the function has different signs brackets such an instant. It is narrowed down to the rounding of t by
 * shorter steps, as between.c makes them. All these points are corrected; so the ends of the step are corrected, too, when events look
 * at them, even where the run itself goes on uncorrected (a correction at every k-th step only): otherwise the function would leap at the
 * ends, and be seen to change its sign where it has no zero.
 *
 * What is left of such leaps (corrections stop within their tolerance, energy corrections are left out near rest) and of the rounding
 * of t is taken out at last: the states on both sides of the instant are mixed until the function of the mixture is zero.
 * Reported is that end of the bracket where the event has happened, so that a run which starts there does not meet it again.
 */
#include "events.h"

#include <math.h>

static const double RESOLUTION = 4 * 0x1p-52;   /* of the largest value in a bracket: its width when it is done */

zd_watch zd_watch_take(zd_arena *arena, const zd_events *events, zd_output *output)
{
    if (!events) return (zd_watch){.events = NULL};
    size_t count = (size_t)events->count;
    const zd_motion *motion = output->stepper->motion;
    return (zd_watch){
        .events = events,
        .output = output,
        .reader = zd_reader_take(arena, events, &motion->system),
        .before = zd_take_doubles(arena, count),
        .now = zd_take_doubles(arena, count),
        .bracket = zd_take(arena, count * sizeof(zd_bracket)),
        .end = zd_place_take(arena, motion),
        .early = zd_place_take(arena, motion),
        .late = zd_place_take(arena, motion),
        .mixed = zd_place_take(arena, motion),
        .found = zd_take(arena, count * sizeof(int)),
    };
}

static int evaluate(zd_watch *self, int event, double *value)
{
    const zd_events *events = self->events;
    const zd_stepper *stepper = self->output->stepper;
    const zd_motion *motion = stepper->motion;
    const double *p = motion->point->p, *v = motion->point->v;
    int status = zd_is_known(events, event) ? zd_read_event(&self->reader, motion->system.data, event, stepper->t, p, v, value)
                                            : events->evaluate(events->data, event, stepper->t, p, v, value);
    if (status) self->failed = event + 1;
    return status;
}

static int evaluate_all(zd_watch *self, double *values)
{
    int status = ZD_DONE;
    for (int i = 0; !status && i < self->events->count; i++) status = evaluate(self, i, &values[i]);
    return status;
}

int zd_watch_start(zd_watch *self)
{
    return evaluate_all(self, self->before);
}

/* What is zero where the step begins has happened before, or it is the start. */
static int happens(const zd_watch *self, int event)
{
    double before = self->before[event], now = self->now[event];
    int direction = self->events->direction[event];
    return (before < 0 && now >= 0 && direction >= 0) || (before > 0 && now <= 0 && direction <= 0);
}

static int correct(zd_stepper *stepper)
{
    return zd_stepper_land(stepper, stepper->t, 0, 1);
}

/* To a time of the step, both ends included, as events see it: corrected. */
static int move(zd_watch *self, double t)
{
    zd_stepper *stepper = self->output->stepper;
    const zd_place *before = &self->output->before, *end = &self->end;
    if (t > before->t && t < end->t) return zd_output_move(self->output, t);
    int status = zd_stepper_return_to(stepper, t == end->t ? end : before);
    return status || t == end->t ? status : correct(stepper);
}

static int locate(zd_watch *self, int event, zd_bracket *it)
{
    const zd_place *before = &self->output->before, *end = &self->end;
    double resolution = RESOLUTION * fmax(fabs(before->t), fabs(end->t));
    *it = zd_bracket_of(before->t, end->t, self->before[event], self->now[event], resolution);
    while (it->b - it->a > resolution) {
        double g, t = zd_bracket_choose(it);
        int status = move(self, t);
        if (!status) status = evaluate(self, event, &g);
        if (status) return status;
        zd_bracket_narrow(it, t, g);
    }
    return ZD_DONE;
}

/* The brackets of those that happen in the step, at infinity for the others; and the first time at which the run has to end. */
static int locate_all(zd_watch *self, double *end)
{
    const zd_events *events = self->events;
    *end = INFINITY;
    for (int i = 0; i < events->count; i++) {
        zd_bracket *it = &self->bracket[i];
        it->b = INFINITY;
        int status = happens(self, i) ? locate(self, i, it) : ZD_DONE;
        if (status) return status;
        if (it->b >= *end || self->found[i] + 1 != events->terminal[i]) continue;
        *end = it->b;
        self->ended = i + 1;
    }
    return ZD_DONE;
}

static void mix_doubles(int n, const double *a, const double *b, double share, double *mixed)
{
    for (int i = 0; i < n; i++) mixed[i] = a[i] + share * (b[i] - a[i]);
}

/* To the mixture of the states at both sides of an event, at the time of the later one. */
static int mix(zd_watch *self, double share)
{
    const zd_motion *motion = self->output->stepper->motion;
    const zd_place *early = &self->early, *late = &self->late;
    zd_place *mixed = &self->mixed;
    if (share == 1) return zd_stepper_return_to(self->output->stepper, late);
    mixed->t = late->t;
    mix_doubles(motion->system.nq, early->p, late->p, share, mixed->p);
    mix_doubles(motion->system.nv, early->v, late->v, share, mixed->v);
    mix_doubles(motion->rate.size - motion->formulation_size, early->extra, late->extra, share, mixed->extra);
    return zd_stepper_return_to(self->output->stepper, mixed);
}

/* To where the event happens. */
static int settle(zd_watch *self, int event)
{
    const zd_bracket *found = &self->bracket[event];
    const zd_stepper *stepper = self->output->stepper;
    zd_bracket it = zd_bracket_of(0, 1, found->ga, found->gb, RESOLUTION);
    int status = move(self, found->a);
    zd_stepper_keep_place(stepper, &self->early);
    if (!status) status = move(self, found->b);
    zd_stepper_keep_place(stepper, &self->late);
    while (!status && it.gb != 0 && it.b - it.a > RESOLUTION) {
        double g, share = zd_bracket_choose(&it);
        status = mix(self, share);
        if (!status) status = evaluate(self, event, &g);
        if (!status) zd_bracket_narrow(&it, share, g);
    }
    return status ? status : mix(self, it.b);
}

static int report_one(zd_watch *self, int event)
{
    const zd_events *events = self->events;
    const zd_stepper *stepper = self->output->stepper;
    int status = settle(self, event);
    if (!status) status = events->found(events->data, event, stepper->t, stepper->motion->point->p, stepper->motion->point->v);
    if (!status) self->found[event]++;
    return status;
}

/* The event that ends the run comes last: there the run stays. */
static int report(zd_watch *self, double end)
{
    int status = ZD_DONE, last = self->ended - 1;
    for (int i = 0; !status && i < self->events->count; i++)
        if (i != last && self->bracket[i].b < INFINITY && self->bracket[i].b <= end) status = report_one(self, i);
    return status || !self->ended ? status : report_one(self, last);
}

static int find_all(zd_watch *self, double *end)
{
    double first_end;
    zd_stepper_keep_place(self->output->stepper, &self->end);
    zd_output_leave_end(self->output);
    int status = locate_all(self, &first_end);
    if (!status) status = report(self, first_end);
    if (self->ended) *end = first_end;
    return status;
}

/* Whether any happens between the last look and this one, at the corrected end of the step. */
static int find_happening(zd_watch *self, int *happening)
{
    int status = evaluate_all(self, self->now);
    for (int i = 0; !status && i < self->events->count; i++) *happening |= happens(self, i);
    return status;
}

int zd_watch_after(zd_watch *self, int corrected, double *end)
{
    zd_stepper *stepper = self->output->stepper;
    int happening = 0, status = ZD_DONE;
    if (!corrected) {
        zd_output_keep_end(self->output);
        zd_output_leave_end(self->output);
        status = correct(stepper);
    }
    if (!status) status = find_happening(self, &happening);
    if (!status && happening) {
        if (corrected) zd_output_keep_end(self->output);
        status = find_all(self, end);
    }
    if (!status && (happening || !corrected) && !self->ended) status = zd_output_return_to_end(self->output);
    double *now = self->now;
    self->now = self->before;
    self->before = now;
    return status;
}
