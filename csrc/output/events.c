/* Events: instants at which a function of the motion passes through zero.
 *
 * A step at whose ends the function has different signs brackets such an instant. It is narrowed down to the rounding of t by
 * shorter steps, as output.c makes them. Reported is that end of the bracket where the event has happened, so that a run which starts
 * there does not meet it again.
 */
#include "../linalg/bracket.h"
#include "../core.h"

static const double RESOLUTION = 4 * 0x1p-52;   /* of the largest |t| of the step: the width of a bracket that is done */

static int look(zd_run *run, int event, double *value)
{
    const zd_events *events = run->settings.events;
    int status = events->evaluate(events->data, event, run->t, run->point->p, run->point->v, value);
    run->watch.failed = status != ZD_DONE;
    return status;
}

static int look_at_all(zd_run *run, double *values)
{
    int status = ZD_DONE;
    for (int i = 0; !status && i < run->settings.events->count; i++) status = look(run, i, &values[i]);
    return status;
}

int zd_events_start(zd_run *run)
{
    return look_at_all(run, run->watch.before);
}

/* What is zero where the step begins has happened before, or it is the start. */
static int happens(const zd_run *run, int event)
{
    double before = run->watch.before[event], now = run->watch.now[event];
    int direction = run->settings.events->direction[event];
    return (before < 0 && now >= 0 && direction >= 0) || (before > 0 && now <= 0 && direction <= 0);
}

static int locate(zd_run *run, int event, double *time)
{
    const zd_place *before = &run->output.before, *after = &run->output.after;
    double resolution = RESOLUTION * fmax(fabs(before->t), fabs(after->t));
    zd_bracket it = zd_bracket_of(before->t, after->t, run->watch.before[event], run->watch.now[event], resolution);
    while (it.b - it.a > resolution) {
        double g, t = zd_bracket_choose(&it);
        int status = zd_output_move(run, t);
        if (!status) status = look(run, event, &g);
        if (status) return status;
        zd_bracket_narrow(&it, t, g);
    }
    *time = it.b;
    return ZD_DONE;
}

/* The times of those that happen in the step, infinite for the others; and the first at which the run has to end. */
static int locate_all(zd_run *run, double *end)
{
    const zd_events *events = run->settings.events;
    zd_watch *watch = &run->watch;
    *end = INFINITY;
    for (int i = 0; i < events->count; i++) {
        watch->time[i] = INFINITY;
        int status = happens(run, i) ? locate(run, i, &watch->time[i]) : ZD_DONE;
        if (status) return status;
        if (watch->time[i] >= *end || watch->found[i] + 1 != events->terminal[i]) continue;
        *end = watch->time[i];
        watch->ended = i + 1;
    }
    return ZD_DONE;
}

static int report(zd_run *run, double end)
{
    const zd_events *events = run->settings.events;
    for (int i = 0; i < events->count; i++) {
        double t = run->watch.time[i];
        if (t == INFINITY || t > end) continue;
        int status = zd_output_move(run, t);
        if (!status) status = events->found(events->data, i, t, run->point->p, run->point->v);
        if (status) return status;
        run->watch.found[i]++;
    }
    return ZD_DONE;
}

int zd_events_after(zd_run *run)
{
    zd_watch *watch = &run->watch;
    int happening = 0, status = look_at_all(run, watch->now);
    for (int i = 0; i < run->settings.events->count; i++) happening |= happens(run, i);
    if (!status && happening) {
        double end, t1 = run->t;
        zd_output_keep_end(run);
        status = locate_all(run, &end);
        if (!status) status = report(run, end);
        if (!status) status = zd_output_move(run, watch->ended ? end : t1);
        if (watch->ended) run->settings.t1 = end;
    }
    double *now = watch->now;
    watch->now = watch->before;
    watch->before = now;
    return status;
}
