#include "reading.h"

#include <math.h>

#include "../constraints/rank.h"
#include "../laws/program.h"

zd_reader zd_reader_create(zd_arena *arena, const zd_events *events, const zd_system *run, const double *inputs, const zd_point *point)
{
    if (!events || !events->known) return (zd_reader){.events = events};
    const zd_system *of = events->of ? events->of : run;
    int most = 0;
    for (int i = 0; i < events->count; i++)
        if (events->known[i].readings > most) most = events->known[i].readings;
    return (zd_reader){
        .events = events,
        .of = of,
        .inputs = inputs,
        .point = point,
        .x = zd_arena_doubles(arena, most),
        .measured = zd_arena_doubles(arena, zd_largest_measure(of->measures)),
        .scratch = zd_arena_doubles(arena, of->measures ? of->measures->scratch : 0),
    };
}

static int is_within(int index, int count)
{
    return index >= 0 && index < count;
}

static int is_of_accelerations(const zd_argument *reading, const zd_measures *measures)
{
    return reading->what == ZD_READS_MULTIPLIER
        || (reading->what == ZD_READS_MEASURE && measures->measure[reading->index].depends == ZD_OF_ACCELERATIONS);
}

int zd_acts(const zd_events *events, int event)
{
    int any = 0;
    for (int i = 0; i < events->actions; i++) any |= events->action[i].event == event;
    return any;
}

int zd_reads_accelerations(const zd_events *events, const zd_system *run, const zd_phase_system *phase, int event)
{
    const zd_event *known = events->known ? events->known + event : NULL;
    for (int k = 0; known && k < known->readings; k++) {
        const zd_argument *reading = known->reading + k;
        if (reading->what == ZD_READS_GROUP) return zd_margin_reads_accelerations(phase, reading->index);
        if (is_of_accelerations(reading, (events->of ? events->of : run)->measures)) return 1;
    }
    return 0;
}

static int can_be_read(const zd_argument *reading, const zd_system *run, const zd_measures *measures)
{
    switch (reading->what) {
    case ZD_READS_P: return is_within(reading->index, run->nq);
    case ZD_READS_V: return is_within(reading->index, run->nv);
    case ZD_READS_MULTIPLIER: return is_within(reading->index, zd_constraints(run));
    case ZD_READS_MEASURE:
        return measures && is_within(reading->index, measures->count)
               && is_within(reading->component, measures->measure[reading->index].size);
    case ZD_READS_TIME:
    case ZD_READS_NUMBER:
    case ZD_READS_GROUP: break;
    }
    return 1;
}

const char *zd_wrong_readings(const zd_events *events, const zd_system *run)
{
    const zd_measures *measures = (events->of ? events->of : run)->measures;
    for (int i = 0; events->known && i < events->count; i++)
        for (int k = 0; k < events->known[i].readings; k++)
            if (!can_be_read(&events->known[i].reading[k], run, measures)) return "an event must read quantities that the system has";
    return NULL;
}

/* x <- argument of an event; `out` is that of the earlier arguments, at the same state */
static int read(const zd_reader *self, const void *data, const zd_argument *reading, double t, const double *p, const double *v,
                zd_measured *out, double *x)
{
    switch (reading->what) {
    case ZD_READS_TIME: *x = t; break;
    case ZD_READS_P: *x = p[reading->index]; break;
    case ZD_READS_V: *x = v[reading->index]; break;
    case ZD_READS_NUMBER: *x = reading->number; break;
    case ZD_READS_MULTIPLIER: *x = zd_point_multipliers(self->point)[reading->index]; break;
    case ZD_READS_GROUP: return zd_phase_margin(self->point->phase, self->point, reading->index, t, p, v, x);
    case ZD_READS_MEASURE: {
        const double *vdot = self->point ? self->point->vdot : NULL, *lambda = self->point ? zd_point_multipliers(self->point) : NULL;
        if (self->of->measures->evaluate(data, self->inputs, reading->index, t, p, v, vdot, lambda, out, self->scratch)) return ZD_CALLBACK;
        out->is_same_state = 1;
        *x = self->measured[reading->component];
    }
    }
    return ZD_DONE;
}

int zd_read_event(const zd_reader *self, const void *data, int event, double t, const double *p, const double *v, double *value)
{
    const zd_event *known = self->events->known + event;
    const void *of = self->events->of ? self->of->data : data;
    zd_measured out = {.value = self->measured, .is_least = self->point && !zd_rank_is_deficient(self->point)};
    for (int k = 0; k < known->readings; k++)
        if (read(self, of, known->reading + k, t, p, v, &out, self->x + k)) return ZD_CALLBACK;
    if (known->is_called) return self->events->evaluate(self->events->data, event, t, p, v, self->x, value);
    *value = self->x[0];
    if (known->function) zd_expressions_evaluate(known->function, self->x, 0, NULL, NULL, value);
    *value -= known->value;
    return isfinite(*value) ? ZD_DONE : ZD_CALLBACK;
}
