/* Samples of runs in lanes that are due within the last step and at its end. */
#include <math.h>

#include "group.h"

#include "../linalg/small.h"

static int64_t entries_of_p(const zd_lane_group *self) { return self->lanes.nq; }

/* Saves the multipliers of all constraints; those of groups are zero, as none acts. */
static void save_multipliers(const zd_lane_group *self, int lane, int64_t sample)
{
    const zd_lanes *lanes = &self->lanes;
    const zd_point *point = self->run->motion.point;
    double *to = self->batch->multipliers + sample * zd_point_constraints(point);
    if (!point->phase) zd_lane_store(lanes, lane, lanes->m, lanes->lambda_sample, to);
    for (int k = 0; point->phase && k < zd_point_constraints(point); k++) {
        const int row = point->phase->row_here[k];
        to[k] = row < 0 ? 0 : zd_lane_number(lanes, lanes->lambda_sample, row, lane);
    }
}

/* Saves y_sample at t_sample as a sample of the run. */
static void save_sample(zd_lane_group *self, int lane)
{
    const zd_batch *batch = self->batch;
    const zd_lanes *lanes = &self->lanes;
    zd_lane_run *run = &self->run_of[lane];
    if (run->samples == batch->capacity) return;
    const int64_t sample = run->number * batch->capacity + run->samples++;
    if (batch->t) batch->t[sample] = lanes->t_sample[lane];
    if (batch->p) zd_lane_store(lanes, lane, lanes->nq, lanes->y_sample, batch->p + sample * entries_of_p(self));
    if (batch->v) zd_lane_store(lanes, lane, lanes->nv, lanes->y_sample + entries_of_p(self) * lanes->lanes, batch->v + sample * lanes->nv);
    if (batch->input) batch->input[sample] = lanes->has_input ? zd_lane_number(lanes, lanes->y_sample, lanes->size - 1, lane) : 0;
    if (batch->iterations) batch->iterations[sample] = (int)lanes->peak_iterations[lane];
    if (batch->energy_skipped) batch->energy_skipped[sample] = run->of_energy.skipped_since_sample;
    lanes->peak_iterations[lane] = 0;
    run->of_energy.skipped_since_sample = 0;
    if (batch->multipliers) save_multipliers(self, lane, sample);
}

static double next_time(const zd_lane_group *self, const zd_lane_run *run)
{
    const zd_settings *settings = self->batch->settings;
    return run->next < settings->t_evals ? settings->t_eval[run->next] : INFINITY;
}

void zd_lane_group_set_next(zd_lane_group *self, int lane)
{
    zd_lanes *lanes = &self->lanes;
    const double every = lanes->save_every;
    const int by_time = self->batch->settings->t_eval != NULL;
    if (lanes->t[lane] < lanes->next_t[lane] && lanes->number[lane] < lanes->next_number[lane]) return;    /* no sample was due */
    lanes->next_t[lane] = fmin(lanes->end, by_time ? next_time(self, &self->run_of[lane]) : INFINITY);
    lanes->next_number[lane] = by_time ? INFINITY : every * (floor(lanes->number[lane] / every) + 1);
}

/* is_due() for a run that an event has ended within the step: times before the event, then the event, to which the lane is set. */
static int is_due_before_end(zd_lane_group *self, int lane, double *when)
{
    const zd_lanes *lanes = &self->lanes;
    zd_lane_run *run = &self->run_of[lane];
    *when = self->batch->settings->t_eval ? next_time(self, run) : INFINITY;
    if (*when < run->search.end && !run->search.is_at_end) return 1;
    if (!run->search.is_at_end) zd_lane_group_go_to_end(self, lane);
    *when = lanes->t[lane];
    return !run->is_complete && !run->search.goes_on;
}

/* True if a sample of the lane's run is due by the end of the last step, at *when. Without t_eval, samples are due every save_every
 * steps. */
static int is_due(zd_lane_group *self, int lane, double *when)
{
    const zd_lanes *lanes = &self->lanes;
    const zd_lane_run *run = &self->run_of[lane];
    if (run->number < 0 || lanes->leaves[lane] != 0) return 0;
    if (run->search.ended) return is_due_before_end(self, lane, when);
    if (self->batch->settings->t_eval) {
        *when = next_time(self, run);
        return *when <= lanes->t[lane];
    }
    *when = lanes->t[lane];
    return run->next == 0 && (lanes->number[lane] >= lanes->next_number[lane] || lanes->t[lane] == lanes->end);
}

/* Marks the lanes that have a sample due; returns 1 if any has; *is_within: one of these lies within the step. */
static int mark(zd_lane_group *self, int *is_within)
{
    zd_lanes *lanes = &self->lanes;
    int any = 0;
    *is_within = 0;
    for (int lane = 0; lane < lanes->lanes; lane++) {
        double when = lanes->t[lane];
        const int due = is_due(self, lane, &when);
        lanes->is_wanted[lane] = due;
        lanes->t_sample[lane] = due ? when : lanes->t[lane];
        any |= due;
        *is_within |= due && when != lanes->t[lane];
    }
    return any;
}

static void save_marked(zd_lane_group *self)
{
    zd_lanes *lanes = &self->lanes;
    for (int lane = 0; lane < lanes->lanes; lane++) {
        if (lanes->is_wanted[lane] == 0 || lanes->leaves[lane] != 0) continue;
        save_sample(self, lane);
        self->run_of[lane].next++;
        self->run_of[lane].is_complete |= self->run_of[lane].search.is_at_end;
    }
}

void zd_lane_group_save(zd_lane_group *self)
{
    zd_lanes *lanes = &self->lanes;
    const int by_time = self->batch->settings->t_eval != NULL, multipliers = self->batch->multipliers != NULL;
    int is_within;
    while (mark(self, &is_within)) {
        if (is_within || multipliers) self->functions->move_within(lanes, multipliers);
        else zd_copy_all(lanes->size * lanes->lanes, lanes->y, lanes->y_sample);
        save_marked(self);
    }
    for (int lane = 0; lane < lanes->lanes && !by_time; lane++) self->run_of[lane].next = 0;
}
