/* Events: instants at which a function of the motion passes through zero.
 *
 * A step at whose ends the function has different signs brackets such an instant. It is narrowed down to the rounding of t by
 * shorter steps, as between.c makes them. Reported is that end of the bracket where the event has happened, so that a run which starts
 * there does not meet it again.
 */
#include "events.h"

#include <math.h>

#include "../linalg/bracket.h"

static const double RESOLUTION = 4 * 0x1p-52;   /* of the largest |t| of the step: the width of a bracket that is done */

zd_watch zd_watch_take(zd_arena *arena, const zd_events *events, zd_output *output)
{
    size_t count = events ? (size_t)events->count : 0;
    return (zd_watch){
        .events = events,
        .output = output,
        .before = zd_take_doubles(arena, count),
        .now = zd_take_doubles(arena, count),
        .time = zd_take_doubles(arena, count),
        .found = zd_take(arena, count * sizeof(int)),
    };
}

static int evaluate(zd_watch *self, int event, double *value)
{
    const zd_events *events = self->events;
    const zd_stepper *stepper = self->output->stepper;
    int status = events->evaluate(events->data, event, stepper->t, stepper->motion->point->p, stepper->motion->point->v, value);
    self->failed = status != ZD_DONE;
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

static int locate(zd_watch *self, int event, double *time)
{
    const zd_place *before = &self->output->before, *after = &self->output->after;
    double resolution = RESOLUTION * fmax(fabs(before->t), fabs(after->t));
    zd_bracket it = zd_bracket_of(before->t, after->t, self->before[event], self->now[event], resolution);
    while (it.b - it.a > resolution) {
        double g, t = zd_bracket_choose(&it);
        int status = zd_output_move(self->output, t);
        if (!status) status = evaluate(self, event, &g);
        if (status) return status;
        zd_bracket_narrow(&it, t, g);
    }
    *time = it.b;
    return ZD_DONE;
}

/* The times of those that happen in the step, infinite for the others; and the first at which the run has to end. */
static int locate_all(zd_watch *self, double *end)
{
    const zd_events *events = self->events;
    *end = INFINITY;
    for (int i = 0; i < events->count; i++) {
        self->time[i] = INFINITY;
        int status = happens(self, i) ? locate(self, i, &self->time[i]) : ZD_DONE;
        if (status) return status;
        if (self->time[i] >= *end || self->found[i] + 1 != events->terminal[i]) continue;
        *end = self->time[i];
        self->ended = i + 1;
    }
    return ZD_DONE;
}

static int report(zd_watch *self, double end)
{
    const zd_events *events = self->events;
    const zd_stepper *stepper = self->output->stepper;
    for (int i = 0; i < events->count; i++) {
        double t = self->time[i];
        if (t == INFINITY || t > end) continue;
        int status = zd_output_move(self->output, t);
        if (!status) status = events->found(events->data, i, t, stepper->motion->point->p, stepper->motion->point->v);
        if (status) return status;
        self->found[i]++;
    }
    return ZD_DONE;
}

/* Those that happen in the step are located and told, and the motion goes to where the step ends, or the run. */
static int take_events(zd_watch *self, double *end)
{
    double first_end, t1 = self->output->stepper->t;
    zd_output_keep_end(self->output);
    int status = locate_all(self, &first_end);
    if (!status) status = report(self, first_end);
    if (!status) status = zd_output_move(self->output, self->ended ? first_end : t1);
    if (self->ended) *end = first_end;
    return status;
}

int zd_watch_after(zd_watch *self, double *end)
{
    int happening = 0, status = evaluate_all(self, self->now);
    for (int i = 0; i < self->events->count; i++) happening |= happens(self, i);
    if (!status && happening) status = take_events(self, end);
    double *now = self->now;
    self->now = self->before;
    self->before = now;
    return status;
}
