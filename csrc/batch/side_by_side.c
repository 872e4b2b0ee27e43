/* Runs of a batch in SIMD lanes: a lane whose run has ended gets the next one; runs that lanes cannot make are made individually. */
#include "batch.h"

#include "../registry.h"
#include "../run/phases.h"
#include "group.h"

/* ---- applicability of lanes ---- */

static int are_known(const zd_events *events, const zd_system *system)
{
    for (int i = 0; events && i < events->count; i++)
        if (!zd_is_known(events, i) || zd_reads_accelerations(events, system, NULL, i)) return 0;
    return 1;
}

int zd_lanes_serve_settings(const zd_system *system, const zd_settings *settings)
{
    const int meets_breaks = (system->breaks || system->switches) && settings->steps == ZD_ADAPTIVE_STEPS;
    return !system->quaternions && !meets_breaks && !settings->outputs && !settings->given_jacobian && !(settings->max_move > 0)
        && (system->groups || system->mh + system->mn <= system->nv) && zd_takes_closed_form(settings)
        && !zd_takes_embeddings(settings) && zd_integrator_of(settings->integrator)->create == zd_runge_kutta_create;
}

int zd_lanes_serve(const zd_batch *batch)
{
    const zd_system *system = batch->system;
    const zd_settings *settings = batch->settings;
    const zd_closed_form *closed_form;
    return batch->lanes && !batch->settings_differ && !batch->family && batch->doubles && !system->structure
        && are_known(settings->events, system) && zd_lanes_serve_settings(system, settings)
        && zd_lane_functions_of(system, settings->vector, &closed_form) != NULL;
}

/* True if the corrections after the projection can be made lane by lane. Events require them in each step. */
static int rest_serves(const zd_run *run)
{
    const zd_motion *motion = &run->motion;
    for (int i = 0; i < motion->corrections; i++)
        if (!motion->active[i].row->after_step || (run->settings.events && motion->active[i].every != 1)) return 0;
    return !motion->is_stabilized;
}

int zd_lanes_serve_run(const zd_run *run)
{
    const zd_motion *motion = &run->motion;
    const zd_constraint_target *target = &motion->target;
    if (!zd_has_closed_form(motion) || motion->statistics.rank != zd_constraints(&motion->system)) return 0;
    if (motion->formulation_size != motion->system.nq + motion->system.nv || motion->corrections_size) return 0;
    if (motion->corrections == 0) return 1;
    return rest_serves(run) && target->positions && target->velocities && target->in_mass_metric;
}

/* ---- memory ---- */

static zd_lane_group lay_out(zd_arena *arena, const zd_batch *batch, const zd_single_run *own, zd_system *full, zd_run *run)
{
    const zd_system *system = &run->motion.system;
    const size_t size_of_C = zd_constraints(system) * system->nv;
    const zd_closed_form *closed_form = NULL;
    zd_lane_group group = {
        .batch = batch, .own = own, .system = full, .run = run,
        .functions = zd_lane_functions_of(full, batch->settings->vector, &closed_form),
        .start = zd_arena_bytes(arena, zd_run_start_memory(run)),
        .p = zd_arena_doubles(arena, system->nq),
        .v = zd_arena_doubles(arena, system->nv),
        .C = zd_arena_doubles(arena, size_of_C),
        .numbers = batch->settings->inputs ? zd_arena_doubles(arena, batch->doubles) : NULL,
        .terms = {.scratch = zd_arena_doubles(arena, system->scratch), .inputs = run->motion.point->inputs},
    };
    zd_lanes_create(&group.lanes, arena, run, group.functions, closed_form, batch->doubles);
    group.reader = zd_reader_create(arena, batch->settings->events, system, run->motion.point->inputs, NULL);
    for (int lane = 0; lane < ZD_MAX_LANES; lane++)
        group.run_of[lane] = (zd_lane_run){
            .number = -1,
            .C = zd_arena_doubles(arena, size_of_C),
            .search = zd_lane_search_create(arena, &group.lanes),
            .gaps = {zd_gaps_create(arena, full, full->groups), zd_gaps_create(arena, full, full->groups)},
        };
    return group;
}

/* ---- runs ---- */

/* Finds the start of a run; its system is copied only if it has to be projected. */
static int start_of(const zd_batch *batch, const zd_single_run *own, int64_t number)
{
    if (!batch->assembly) return zd_single_run_start(batch, batch->system, own, number);
    const zd_system system = zd_single_run_system(batch, number);
    return zd_single_run_start(batch, &system, own, number);
}

/* True if all contacts are open by more than ZD_TOUCHING at the start of the run. */
static int is_apart(const zd_lane_group *self)
{
    const zd_run *run = self->run;
    const zd_point *point = run->motion.point;
    int is = 1;
    for (int g = 0; run->phases && is && g < self->system->groups; g++) {
        double margin;
        is = !zd_phase_margin(point->phase, point, g, point->t, point->p, point->v, &margin) && margin > ZD_TOUCHING * run->phases->length;
    }
    return is;
}

/* Finds the next run that can begin in a lane; others are made individually. Returns 0 if there is none. */
static int find_next(zd_lane_group *self)
{
    const zd_batch *batch = self->batch;
    while (self->next < batch->runs && !zd_batch_is_stopped(batch)) {
        const int64_t number = self->next++;
        int status = start_of(batch, self->own, number);
        const void *data = zd_lane_group_data_of(self, zd_single_run_data(batch, number));
        if (!status) status = zd_run_start_elsewhere(self->run, self->start, data, self->own->p, self->own->v);
        if (!status && is_apart(self)) return 1;
        zd_single_run_execute(batch, self->own, number);
    }
    return 0;
}

static void begin(zd_lane_group *self, int lane)
{
    const int64_t number = self->next - 1;
    zd_lanes_load(&self->lanes, lane, self->run, zd_single_run_data(self->batch, number), self->batch->doubles);
    self->run_of[lane].number = number;
    self->run_of[lane].samples = self->run_of[lane].next = 0;
    zd_event_samples_clear(self->batch, number);
    self->active++;
    zd_lane_group_note_start(self, lane);
}

/* Begins the next run in the lane; if there is none, the lane is inactive, with the numbers of an active one. */
static void fill(zd_lane_group *self, int lane)
{
    zd_lanes *lanes = &self->lanes;
    self->run_of[lane].number = -1;
    if (find_next(self)) {
        begin(self, lane);
        return;
    }
    int other = 0;
    for (int i = 0; i < lanes->lanes; i++)
        if (self->run_of[i].number >= 0) other = i;
    zd_lanes_copy(lanes, other, lane);
    lanes->is_active[lane] = lanes->leaves[lane] = lanes->is_long[lane] = lanes->has_event[lane] = 0;
}

/* Writes the message of a run that an event has ended. */
static int say_event(const zd_lane_group *self, int lane)
{
    const zd_batch *batch = self->batch;
    const zd_lanes *lanes = &self->lanes;
    const zd_lane_run *run = &self->run_of[lane];
    char *message = zd_message_of(batch, run->number);
    const size_t size = batch->message_size, said = zd_say_where(message, size, lanes->t[lane], (int64_t)lanes->number[lane],
                                                                         self->run->loop.steps);
    zd_say_event(message + said, size - said, run->search.ended - 1);
    return ZD_EVENT;
}

/* Number of steps of the lane that were projected onto the constraints. */
static int64_t count_corrected(const zd_lanes *lanes, int lane)
{
    const int64_t steps = (int64_t)lanes->number[lane], every = (int64_t)lanes->every;
    return steps / every + (steps % every != 0 && lanes->t[lane] == lanes->end);
}

static void end(zd_lane_group *self, int lane)
{
    const zd_lanes *lanes = &self->lanes;
    const zd_lane_run *run = &self->run_of[lane];
    const int64_t number = run->number, steps = (int64_t)lanes->number[lane];
    self->batch->way[number] = ZD_IN_LANES;
    self->batch->samples[number] = self->run_of[lane].samples;
    self->batch->status[number] = self->run_of[lane].search.ended ? say_event(self, lane) : ZD_DONE;
    self->batch->statistics[number] = (zd_statistics){
        .steps = steps, .closed_form_steps = steps, .rejected = (int64_t)lanes->rejected[lane],
        .position_iterations = (int64_t)lanes->iterations[lane], .velocity_corrections = lanes->corrects ? count_corrected(lanes, lane) : 0,
        .stiff = (int64_t)lanes->stiff[lane],
        .energy_corrections = run->of_energy.corrections, .energy_skipped = run->of_energy.skipped,
        .energy_corrected = run->of_energy.corrected,
        .unresolved = (int64_t)lanes->unresolved[lane], .unresolved_time = lanes->unresolved_time[lane],
        .part_error = lanes->part_error[lane], .part = (int)lanes->part[lane],
        .rank = lanes->m,
    };
}

/* Ends the lane's run if it is complete or has to be made individually; returns 1 if so. */
static int is_over(zd_lane_group *self, int lane)
{
    zd_lanes *lanes = &self->lanes;
    const zd_settings *settings = self->batch->settings;
    zd_lane_run *run = &self->run_of[lane];
    if (run->number < 0) return 0;
    if (lanes->leaves[lane] != 0) {
        zd_single_run_execute(self->batch, self->own, run->number);
        return 1;
    }
    const int is_complete = run->is_complete || (settings->t_eval && !settings->events && run->next == settings->t_evals);
    if (!is_complete && lanes->t[lane] != lanes->end) return 0;
    if (zd_lane_group_keeps_energy(self, lane) && !run->is_off) end(self, lane);
    else zd_single_run_execute(self->batch, self->own, run->number);
    return 1;
}

/* Replaces runs that have ended; returns 1 if a run has begun, whose first sample may be due. */
static int replace(zd_lane_group *self)
{
    int has_begun = 0;
    for (int lane = 0; lane < self->lanes.lanes; lane++) {
        if (is_over(self, lane)) {
            self->active--;
            fill(self, lane);
            has_begun |= self->run_of[lane].number >= 0;
        } else if (self->run_of[lane].number >= 0) zd_lane_group_set_next(self, lane);
    }
    if (has_begun) self->functions->choose(&self->lanes);
    return has_begun;
}

/* Checks, events, samples and replacements after the last steps. */
static void check(zd_lane_group *self)
{
    zd_lanes *lanes = &self->lanes;
    for (int lane = 0; lane < lanes->lanes; lane++) {
        if (lanes->is_long[lane] == 0 || !zd_lane_has_run(self, lane)) continue;
        if (zd_lane_group_is_turned(self, lane)) lanes->leaves[lane] = 1;
        lanes->is_long[lane] = 0;
    }
    zd_lane_group_check_closely(self);
    if (lanes->watches) zd_lane_group_locate(self);
    do zd_lane_group_save(self);
    while (replace(self));
    if (self->batch->settings->inputs) zd_lane_group_act(self);
}

static void run_all(zd_lane_group *self)
{
    self->lanes.of = self;
    if (self->run->motion.corrections > 1) self->lanes.correct_rest = zd_lane_group_correct_rest;
    for (int lane = 0; lane < self->lanes.lanes; lane++) fill(self, lane);
    self->functions->choose(&self->lanes);
    while (self->active && !zd_batch_is_stopped(self->batch)) {
        check(self);
        if (self->active) self->functions->advance(&self->lanes);
    }
}

/* Creates the first run that can be, to evaluate starts; those before it, which fail or begin with closed contacts, are made
 * individually. */
static zd_run *create_first(const zd_batch *batch, const zd_single_run *own, zd_system *system, int64_t *first)
{
    for (*first = 0; *first < batch->runs && !zd_batch_is_stopped(batch); ++*first) {
        *system = zd_single_run_system(batch, *first);
        int status = zd_single_run_start(batch, system, own, *first);
        zd_run *run = status ? NULL : zd_run_create(system, batch->settings, own->p, own->v, &status, zd_message_of(batch, *first),
                                                    batch->message_size);
        if (run && (!run->phases || zd_lanes_serve_run(run))) return run;
        zd_run_free(run);
        zd_single_run_execute(batch, own, *first);
    }
    return NULL;
}

static int run_in_lanes(const zd_batch *batch, const zd_single_run *own, zd_system *system, zd_run *run, int64_t first)
{
    zd_arena arena = {0};
    lay_out(&arena, batch, own, system, run);
    if (!zd_arena_allocate(&arena)) return ZD_NO_MEMORY;
    zd_lane_group group = lay_out(&arena, batch, own, system, run);
    group.next = first;
    run_all(&group);
    zd_release(arena.base);
    return ZD_DONE;
}

int zd_run_side_by_side(const zd_batch *batch, const zd_single_run *own)
{
    int64_t first;
    zd_system system;
    zd_run *run = create_first(batch, own, &system, &first);
    if (!run) return ZD_DONE;
    int status = ZD_DONE;
    if (zd_lanes_serve_run(run)) status = run_in_lanes(batch, own, &system, run, first);
    else
        for (int64_t i = first; i < batch->runs && !zd_batch_is_stopped(batch); i++) zd_single_run_execute(batch, own, i);
    zd_run_free(run);
    return status;
}
