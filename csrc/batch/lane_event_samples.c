/* Values of event functions in lanes, and their samples within a step. */
#include <math.h>

#include "../step_limits.h"
#include "group.h"

zd_lane_search zd_lane_search_create(zd_arena *arena, const zd_lanes *lanes)
{
    if (!lanes->watches) return (zd_lane_search){.ended = 0};
    const size_t events = lanes->events, size = lanes->size;
    return (zd_lane_search){
        .before = zd_arena_doubles(arena, events),
        .now = zd_arena_doubles(arena, events),
        .zeros = zd_arena_bytes(arena, events * sizeof(zd_zeros)),
        .occurrence = zd_arena_bytes(arena, events * ZD_MAX_POINTS * sizeof(zd_occurrence)),
        .early = zd_arena_doubles(arena, size),
        .acts = zd_arena_ints(arena, events),
        .mixed = zd_arena_doubles(arena, size),
    };
}

/* ---- event functions ---- */

/* Value of an event function at the gathered state. If it fails, the run is repeated individually, which reports the failure. */
double zd_lane_group_evaluate(zd_lane_group *self, int lane, int event, double t)
{
    double value = 0;
    const zd_point *point = self->run->motion.point;
    const void *data = zd_lane_group_data(self, lane);
    const int own = zd_lane_group_own_events(self);
    if (event < own ? zd_read_event(&self->reader, data, event, t, self->p, self->v, &value)
                    : zd_phase_margin(point->phase, point, event - own, t, self->p, self->v, &value)) self->lanes.leaves[lane] = 1;
    return value;
}

void zd_lane_group_evaluate_all(zd_lane_group *self, int lane, double t, const double *y, double *values)
{
    zd_lane_group_gather(self, lane, y);
    for (int i = 0; i < self->lanes.events; i++) values[i] = zd_lane_group_evaluate(self, lane, i, t);
}

/* Change of an event function when the gathered state changes by its rounding. */
double zd_lane_group_rounding(zd_lane_group *self, int lane, int event, double t, double value)
{
    zd_run *run = self->run;
    double rounding = 0;
    run->motion.system.data = zd_lane_group_data(self, lane);
    run->stepper.t = t;
    zd_point_move(run->motion.point, t, self->p, self->v);
    if (zd_watch_rounding(&run->watch, event, value, &rounding)) self->lanes.leaves[lane] = 1;
    return rounding;
}

/* ---- samples within the step ---- */

/* Sets the ends of the step in the points of all events. */
void zd_lane_group_span(zd_lane_group *self, int lane)
{
    const zd_lanes *lanes = &self->lanes;
    const zd_lane_search *search = &self->run_of[lane].search;
    const int last = ZD_SAMPLES + 1;
    for (int i = 0; i < lanes->events; i++) {
        zd_zeros *zeros = &search->zeros[i];
        zeros->count = last + 1;
        zeros->expected = NAN;
        zeros->t[0] = lanes->t_before[lane], zeros->g[0] = search->before[i];
        zeros->t[last] = lanes->t[lane], zeros->g[last] = search->now[i];
    }
}

/* One part of the state, or its rates, by the cubic Hermite polynomial of the step. */
static void predict_part(const zd_lanes *lanes, int lane, double x, int first, int count, const double *rate1, double *to)
{
    const double h = lanes->t[lane] - lanes->t_before[lane];
    for (int i = 0; i < count; i++) {
        const double y0 = zd_lane_number(lanes, lanes->y0, first + i, lane), y1 = zd_lane_number(lanes, lanes->y, first + i, lane);
        const double slope0 = zd_lane_number(lanes, lanes->k, first + i, lane), slope1 = zd_lane_number(lanes, rate1, i, lane);
        zd_interpolate_cubic(1, x, h, &y0, &slope0, &y1, &slope1, to + i);
    }
}

/* Values of the event functions by cubic Hermite polynomials; events that cannot occur twice keep the ends of the step alone. */
int zd_lane_group_predict(zd_lane_group *self, int lane)
{
    const zd_lanes *lanes = &self->lanes;
    const zd_lane_search *search = &self->run_of[lane].search;
    int any = 0;
    for (int k = 1; k <= ZD_SAMPLES; k++) {
        const double x = zd_sample_share(k), t = lanes->t_before[lane] + x * (lanes->t[lane] - lanes->t_before[lane]);
        predict_part(lanes, lane, x, 0, lanes->nq, lanes->has_A ? lanes->pdot : lanes->y + lanes->nq * lanes->lanes, self->p);
        predict_part(lanes, lane, x, lanes->nq, lanes->nv, lanes->vdot, self->v);
        for (int i = 0; i < lanes->events; i++) {
            search->zeros[i].t[k] = t;
            search->zeros[i].g[k] = zd_lane_group_evaluate(self, lane, i, t);
        }
    }
    for (int i = 0; i < lanes->events; i++)
        if (zd_zeros_are_paired(&search->zeros[i])) any = 1;
        else zd_zeros_keep_ends(&search->zeros[i], 1);
    return any;
}

/* Adds the gathered state to the samples of the step. */
void zd_lane_group_add_sample(zd_lane_group *self, int lane, double t)
{
    const zd_lane_search *search = &self->run_of[lane].search;
    for (int i = 0; i < self->lanes.events; i++) {
        if (search->zeros[i].count == 2) continue;
        search->zeros[i].t[search->sample] = t;
        search->zeros[i].g[search->sample] = zd_lane_group_evaluate(self, lane, i, t);
    }
}
