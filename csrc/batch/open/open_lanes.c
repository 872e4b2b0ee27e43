/* Open runs in SIMD lanes, which have the bits of single runs. What lanes cannot make, the run itself makes: a step that they do not accept,
 * and one so long that the rows of C may have reversed. Between two advances the numbers of a group are in its image, and the run itself is
 * behind its lane until it is needed.
 */
#include "open_lanes.h"

#include <math.h>
#include <string.h>

#include "../../step/step_loop.h"
#include "../batch.h"

/* ---- creation ---- */

static int lanes_serve_inputs(const zd_inputs *inputs)
{
    for (int k = 0; inputs && k < inputs->places; k++)
        if (inputs->place[k].is_speed) return 0;
    return 1;
}

/* True if lanes can make the steps of a run like this one. A speed is followed within a step, which lanes do not do. */
static int are_served(const zd_open_runs *runs, const zd_run *run)
{
    const zd_settings *settings = &run->settings;
    const zd_system *system = &run->motion.system;
    const zd_closed_form *closed_form;
    return runs->data && settings->steps == ZD_FIXED_STEPS && !settings->events && lanes_serve_inputs(settings->inputs)
        && zd_lanes_serve_settings(system, settings) && !system->structure && zd_lanes_serve_run(run)
        && run->motion.corrections < 2 && zd_lane_functions_of(system, settings->vector, &closed_form) != NULL;
}

static zd_open_lanes *lay_out(zd_arena *arena, const zd_open_runs *runs, int64_t first, int64_t count)
{
    const zd_run *run = runs->run[first];
    zd_open_lanes nowhere, *here = zd_arena_bytes(arena, sizeof *here), *self = here ? here : &nowhere;
    const zd_closed_form *closed_form;
    const zd_lane_functions *functions = zd_lane_functions_of(&run->motion.system, run->settings.vector, &closed_form);
    const int64_t groups = (count + functions->lanes - 1) / functions->lanes;
    *self = (zd_open_lanes){.runs = runs, .first = first, .count = count, .functions = functions,
                            .order = run->motion.path.closed_form->order};
    zd_lanes_create(&self->lanes, arena, run, functions, closed_form, runs->doubles);
    self->lanes.rounds_products = 1;
    self->lanes.end = INFINITY;
    if (run->motion.system.check_domain) self->lanes.watches = ZD_WATCHES_STEPS;
    self->lanes.steps = -1;         /* no step is the last one */
    self->numbers = self->lanes.states * functions->lanes;
    self->image = zd_arena_doubles(arena, (size_t)groups * self->numbers);
    self->place = zd_arena_bytes(arena, count * sizeof *self->place);
    self->inputs = zd_lane_inputs_create(arena, runs, first, count);
    self->goal = zd_arena_bytes(arena, functions->lanes * sizeof *self->goal);
    self->y = zd_arena_doubles(arena, (size_t)self->lanes.size);
    self->scratch = zd_arena_doubles(arena, (size_t)run->motion.system.scratch);
    return here;
}

zd_open_lanes *zd_open_lanes_create(const zd_open_runs *runs, int64_t first, int64_t count)
{
    zd_arena arena = {0};
    if (!count || !are_served(runs, runs->run[first])) return NULL;
    lay_out(&arena, runs, first, count);
    return zd_arena_allocate(&arena) ? lay_out(&arena, runs, first, count) : NULL;
}

void zd_open_lanes_free(zd_open_lanes *self)
{
    zd_release(self);       /* it begins its block */
}

/* ---- runs of a group ---- */

static int64_t run_of(const zd_open_lanes *self, int64_t group, int lane) { return self->first + group * self->lanes.lanes + lane; }

static int is_in_lane(const zd_open_lanes *self, int64_t i)
{
    return i < self->first + self->count && self->place[i - self->first].is_in;
}

/* Takes the run out of its lane: it is at the start of the step that the lane could not make. */
static void leave(zd_open_lanes *self, int lane, int64_t i)
{
    zd_lanes *lanes = &self->lanes;
    const int is_undone = lanes->leaves[lane] == 0;     /* a long step, which the lane has made */
    const double t = is_undone ? lanes->t_before[lane] : lanes->t[lane], steps = lanes->number[lane] - is_undone;
    const int status = zd_lane_put_back(self, lane, i, t, steps, is_undone ? lanes->y0 : lanes->y);
    self->runs->status[i] = status;
    self->place[i - self->first].is_in = 0;
    lanes->is_active[lane] = lanes->leaves[lane] = lanes->is_long[lane] = 0;
}

/* Fills lanes without a run with the numbers of another one, whose steps have size 0 there. */
static void fill_empty(zd_open_lanes *self, int64_t group)
{
    zd_lanes *lanes = &self->lanes;
    int other = -1;
    for (int lane = 0; lane < lanes->lanes; lane++)
        if (is_in_lane(self, run_of(self, group, lane))) other = lane;
    for (int lane = 0; other >= 0 && lane < lanes->lanes; lane++) {
        if (is_in_lane(self, run_of(self, group, lane))) continue;
        zd_lanes_copy(lanes, other, lane);
        lanes->is_active[lane] = 0;
    }
}

/* Enters runs that can continue in lanes; returns the number of runs in lanes. */
static int enter(zd_open_lanes *self, int64_t group)
{
    zd_lanes *lanes = &self->lanes;
    int count = 0, are_new = 0;
    for (int lane = 0; lane < lanes->lanes; lane++) {
        const int64_t i = run_of(self, group, lane);
        if (i >= self->first + self->count) break;
        if (!self->place[i - self->first].is_in && !self->place[i - self->first].is_slow && self->runs->status[i] >= 0
            && zd_lane_may_enter(self, self->runs->run[i]) && zd_lane_inputs_fit(self, i)) {
            zd_lane_enter(self, lane, i);
            are_new = 1;
        }
        count += self->place[i - self->first].is_in;
    }
    if (are_new && count < lanes->lanes) fill_empty(self, group);
    return count;
}

/* ---- inputs ---- */

/* Reads the inputs of the runs in lanes; those that have new ones get new accelerations. A run with refused inputs leaves. */
static void read_inputs(zd_open_lanes *self, int64_t group)
{
    zd_lanes *lanes = &self->lanes;
    int are_new = 0;
    for (int lane = 0; lane < lanes->lanes; lane++) {
        const int64_t i = run_of(self, group, lane);
        if (!is_in_lane(self, i)) continue;
        const int is_new = zd_lane_inputs_read(self, lane, i);
        are_new |= is_new > 0;
        if (is_new >= 0) continue;
        lanes->leaves[lane] = 1;
        leave(self, lane, i);
        self->runs->status[i] = ZD_BAD_INPUT;
    }
    if (are_new) self->functions->renew(lanes);
}

/* ---- advance ---- */

/* Number of the step at which a lane stops: so many more, or at time t; -1 if a step would have to be shortened, or t is past. */
static int64_t goal_of(const zd_lanes *lanes, int lane, int64_t steps, double t)
{
    const int64_t made = (int64_t)lanes->number[lane];
    int64_t last = steps < INT64_MAX - made ? made + steps : INT64_MAX;
    if (t == INFINITY) return last;
    const double whole = zd_count_steps(lanes->t0, t, lanes->step);
    if (!(t >= lanes->t[lane])) return -1;
    if (!(whole <= (double)last)) return last;
    return fabs((t - lanes->t0) / lanes->step - whole) <= 1e-9 * whole && (int64_t)whole >= made ? (int64_t)whole : -1;
}

static void begin(zd_open_lanes *self, int64_t group, int64_t steps, double t)
{
    zd_lanes *lanes = &self->lanes;
    for (int lane = 0; lane < lanes->lanes; lane++) {
        const int64_t i = run_of(self, group, lane);
        if (!is_in_lane(self, i)) continue;
        self->goal[lane] = goal_of(lanes, lane, steps, t);
        lanes->leaves[lane] = lanes->is_long[lane] = 0;
        lanes->is_active[lane] = (double)self->goal[lane] > lanes->number[lane];
        lanes->next_number[lane] = (double)self->goal[lane];
        if (self->goal[lane] >= 0) continue;
        lanes->leaves[lane] = 1;
        leave(self, lane, i);
    }
}

/* Makes the full checks of the last step that are due. A run that has left a table there repeats the step individually, which reports it. */
static void check(zd_open_lanes *self, int64_t group)
{
    zd_lanes *lanes = &self->lanes;
    int any = 0;
    for (int lane = 0; lane < lanes->lanes; lane++) {
        if (lanes->is_active[lane] == 0 || !lanes->watches) continue;
        const zd_system *system = &self->runs->run[run_of(self, group, lane)]->motion.system;
        zd_lane_store(lanes, lane, lanes->size, lanes->y, self->y);
        if (system->check_domain(system->data, 0, 0, lanes->t[lane], self->y, self->y + lanes->nq, self->scratch)) lanes->is_long[lane] = 1;
    }
    for (int lane = 0; lane < lanes->lanes; lane++) {
        lanes->is_wanted[lane] = lanes->is_active[lane] != 0 && lanes->number[lane] >= lanes->next_check[lane];
        any |= lanes->is_wanted[lane] != 0;
    }
    if (any) self->functions->check(lanes);
}

/* After the last steps: lanes that cannot continue, and those at their goal; returns the number of the others. */
static int count_active(zd_open_lanes *self, int64_t group)
{
    zd_lanes *lanes = &self->lanes;
    int active = 0;
    for (int lane = 0; lane < lanes->lanes; lane++) {
        if (lanes->is_active[lane] == 0) continue;
        if (lanes->leaves[lane] != 0 || lanes->is_long[lane] != 0) leave(self, lane, run_of(self, group, lane));
        else if (lanes->number[lane] >= (double)self->goal[lane]) lanes->is_active[lane] = 0;
        active += lanes->is_active[lane] != 0;
    }
    return active;
}

static int are_to_choose(const zd_lanes *lanes)
{
    for (int lane = 0; lane < lanes->lanes; lane++)
        if (lanes->order[lane] != lanes->order[lane]) return 1;
    return 0;
}

static void advance_lanes(zd_open_lanes *self, int64_t group, int64_t steps, double t)
{
    zd_lanes *lanes = &self->lanes;
    read_inputs(self, group);
    begin(self, group, steps, t);
    if (are_to_choose(lanes)) self->functions->choose(lanes);
    while (count_active(self, group)) {
        self->functions->advance(lanes);
        check(self, group);
    }
}

static void write_state(const zd_open_lanes *self, int lane, int64_t i)
{
    const zd_open_runs *runs = self->runs;
    const zd_lanes *lanes = &self->lanes;
    runs->t[i] = lanes->t[lane];
    for (int k = 0; k < lanes->nq; k++) runs->p[i * lanes->nq + k] = zd_lane_number(lanes, lanes->y, k, lane);
    for (int k = 0; k < lanes->nv; k++) runs->v[i * lanes->nv + k] = zd_lane_number(lanes, lanes->y, lanes->nq + k, lane);
}

/* Advances run i individually to its goal, that of the group or what a lane has left of it. */
static void advance_run(zd_open_lanes *self, int64_t i, int64_t steps, double t)
{
    const zd_statistics *statistics = &self->runs->run[i]->motion.statistics;
    const int64_t before = statistics->closed_form_steps;
    zd_open_runs_advance(self->runs, i, 1, steps, t);
    self->place[i - self->first].is_slow = statistics->closed_form_steps == before;
}

static void advance_group(zd_open_lanes *self, int64_t group, int64_t steps, double t)
{
    zd_lanes *lanes = &self->lanes;
    int64_t made[ZD_MAX_LANES];    /* steps of each run before the advance */
    memcpy(lanes->first, self->image + (size_t)group * self->numbers, self->numbers * sizeof *self->image);
    const int any = enter(self, group);
    for (int lane = 0; lane < lanes->lanes; lane++) {
        const int64_t i = run_of(self, group, lane);
        made[lane] = is_in_lane(self, i) ? (int64_t)lanes->number[lane] : i < self->first + self->count ? self->runs->run[i]->loop.step : 0;
    }
    if (any) advance_lanes(self, group, steps, t);
    for (int lane = 0; lane < lanes->lanes; lane++) {
        const int64_t i = run_of(self, group, lane);
        if (i >= self->first + self->count) break;
        if (!is_in_lane(self, i)) advance_run(self, i, steps - (self->runs->run[i]->loop.step - made[lane]), t);
        else write_state(self, lane, i);
    }
    if (any) memcpy(self->image + (size_t)group * self->numbers, lanes->first, self->numbers * sizeof *self->image);
}

void zd_open_lanes_advance(zd_open_lanes *self, int64_t steps, double t)
{
    for (int64_t group = 0; steps && group * self->lanes.lanes < self->count; group++) advance_group(self, group, steps, t);
}

/* ---- single runs ---- */

int zd_open_lanes_update_run(zd_open_lanes *self, int64_t i)
{
    const int64_t k = i - self->first, group = k / self->lanes.lanes;
    zd_lanes *lanes = &self->lanes;
    const int lane = (int)(k % lanes->lanes);
    if (k < 0 || k >= self->count || !self->place[k].is_in) return ZD_DONE;
    double *image = self->image + (size_t)group * self->numbers;
    memcpy(lanes->first, image, self->numbers * sizeof *image);
    const int status = zd_lane_put_back(self, lane, i, lanes->t[lane], lanes->number[lane], lanes->y);
    memcpy(image, lanes->first, self->numbers * sizeof *image);
    return status;
}

void zd_open_lanes_discard(zd_open_lanes *self, int64_t i)
{
    const int64_t k = i - self->first;
    if (k >= 0 && k < self->count) self->place[k] = (zd_lane_slot){0};
}
