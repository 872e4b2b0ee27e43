/* Inputs of open runs in lanes. The lanes have copies of the present ones in one block, and write changed ones to their own numbers: what
 * belongs to a single run is not touched in an advance, as it lies scattered in memory. A run gets them when it is needed itself.
 */
#include "open_lanes.h"

#include <math.h>
#include <string.h>

#include "../../run/run.h"

static int64_t position_in(const double *block, int64_t size, const double *place)
{
    const uintptr_t begin = (uintptr_t)block, at = (uintptr_t)place;
    return block && at >= begin && at < begin + (uintptr_t)size * sizeof *place ? (int64_t)((at - begin) / sizeof *place) : -1;
}

/* Source from which lanes read the input of a place; neither: only the run itself reads it. */
static zd_lane_input_slot place_of(const zd_run *run, const double *data, int64_t doubles, const zd_input_slot *place)
{
    return (zd_lane_input_slot){
        .input = place->input,
        .in_data = position_in(data, doubles, place->place),
        .in_inputs = position_in(run->motion.point->inputs, run->motion.system.inputs ? 2 * run->motion.system.inputs + 1 : 0, place->place)};
}

zd_lane_inputs zd_lane_inputs_create(zd_arena *arena, const zd_open_runs *runs, int64_t first, int64_t count)
{
    const zd_run *run = runs->run[first];
    const zd_inputs *inputs = run->settings.inputs;
    if (!inputs) return (zd_lane_inputs){0};
    const size_t values = (size_t)count * inputs->count;
    zd_lane_inputs self = {
        .count = inputs->count,
        .places = inputs->places,
        .place = zd_arena_bytes(arena, inputs->places * sizeof *self.place),
        .derive = zd_arena_bytes(arena, inputs->derivations * sizeof *self.derive),
        .value = zd_arena_bytes(arena, count * sizeof *self.value),
        .held = zd_arena_doubles(arena, values),
        .lower = zd_arena_doubles(arena, values),
        .upper = zd_arena_doubles(arena, values),
        .numbers = zd_arena_doubles(arena, runs->doubles)};
    for (int i = 0; self.place && i < inputs->places; i++)
        self.place[i] = place_of(run, runs->data[first], runs->doubles, inputs->place + i);
    for (int i = 0; i < inputs->derivations; i++)
        if (inputs->data[i] == runs->data[first] && self.derive) self.derive[self.derivations++] = inputs->derive[i];
    return self;
}

int zd_lane_inputs_fit(const zd_open_lanes *self, int64_t i)
{
    const zd_run *run = self->runs->run[i];
    const zd_inputs *inputs = run->settings.inputs;
    const zd_lane_inputs *common = &self->inputs;
    int derivations = 0;
    if (!inputs) return !common->count;
    if (inputs->count != common->count || inputs->places != common->places) return 0;
    for (int k = 0; k < inputs->places; k++) {
        const zd_lane_input_slot *place = common->place + k;
        const zd_lane_input_slot found = place_of(run, self->runs->data[i], self->runs->doubles, inputs->place + k);
        if (found.input != place->input || found.in_data != place->in_data || found.in_inputs != place->in_inputs) return 0;
    }
    for (int k = 0; k < inputs->derivations; k++) {
        if (inputs->data[k] != self->runs->data[i]) continue;
        if (derivations == common->derivations || inputs->derive[k] != common->derive[derivations++]) return 0;
    }
    return derivations == common->derivations;
}

int zd_lane_inputs_enter(zd_open_lanes *self, int64_t i)
{
    zd_run *run = self->runs->run[i];
    const zd_inputs *inputs = run->settings.inputs;
    if (!inputs) return 0;
    const int64_t k = i - self->first, begin = k * inputs->count;
    const size_t bytes = inputs->count * sizeof(double);
    const int is_new = run->held.is_new;
    if (is_new) zd_inputs_write(run);
    self->inputs.value[k] = inputs->value;
    memcpy(self->inputs.held + begin, run->held.value, bytes);
    memcpy(self->inputs.lower + begin, inputs->lower, bytes);
    memcpy(self->inputs.upper + begin, inputs->upper, bytes);
    return is_new;
}

void zd_lane_inputs_put_back(zd_open_lanes *self, int64_t i, int has_moved)
{
    zd_run *run = self->runs->run[i];
    zd_lane_slot *place = self->place + (i - self->first);
    if (!place->is_behind) return;
    const size_t count = self->inputs.count;
    memcpy(run->held.value, self->inputs.held + (size_t)(i - self->first) * count, count * sizeof(double));
    run->held.is_new = 1;       /* the step that it makes itself begins with them */
    if (!has_moved) return;
    zd_inputs_write(run);
    place->is_behind = 0;
}

/* Writes the inputs of a run to the numbers of its lane, and recomputes what its system derives from them. */
static void write(zd_open_lanes *self, int lane, const double *held)
{
    zd_lanes *lanes = &self->lanes;
    const zd_lane_inputs *inputs = &self->inputs;
    for (int i = 0; i < inputs->places; i++) {
        const zd_lane_input_slot *place = inputs->place + i;
        if (place->in_data >= 0) zd_lane_set(lanes, lanes->data, place->in_data, lane, held[place->input]);
        if (place->in_inputs >= 0) zd_lane_set(lanes, lanes->inputs, place->in_inputs, lane, held[place->input]);
    }
    if (!inputs->derivations) return;
    for (int64_t i = 0; i < self->runs->doubles; i++) inputs->numbers[i] = zd_lane_number(lanes, lanes->data, i, lane);
    for (int i = 0; i < inputs->derivations; i++) inputs->derive[i](inputs->numbers);
    for (int64_t i = 0; i < self->runs->doubles; i++) zd_lane_set(lanes, lanes->data, i, lane, inputs->numbers[i]);
}

int zd_lane_inputs_read(zd_open_lanes *self, int lane, int64_t i)
{
    const zd_lane_inputs *inputs = &self->inputs;
    if (!inputs->count) return 0;
    const int64_t k = i - self->first, begin = k * inputs->count;
    const double *value = inputs->value[k];
    double *held = inputs->held + begin;
    for (int j = 0; j < inputs->count; j++)
        if (!isfinite(value[j]) || value[j] < inputs->lower[begin + j] || value[j] > inputs->upper[begin + j]) return -1;
    const size_t bytes = inputs->count * sizeof *held;
    if (!memcmp(held, value, bytes)) return 0;
    memcpy(held, value, bytes);
    self->place[k].is_behind = 1;
    write(self, lane, held);
    return 1;
}
