/* Inputs are constant within a step, except speeds: these follow an input linearly, so that velocities do not jump: over one fixed step, or
 * over a given time in which steps are adaptive, and which ends with one of them. Or they jump, see jump.c. A change
 * makes what is known at the start of the step invalid; without a change nothing is done, and the bits are those of a run without inputs.
 */
#include "run.h"

#include <math.h>
#include <string.h>

static const double MIN_STEP_SHARE = 1e-9;  /* smallest remainder of a step that an event has cut */

static size_t count_speeds(const zd_inputs *inputs)
{
    size_t count = 0;
    for (int k = 0; inputs && k < inputs->places; k++) count += inputs->place[k].is_speed != 0;
    return count;
}

int zd_inputs_have_speeds(const zd_inputs *inputs) { return count_speeds(inputs) > 0; }

static void keep_speeds(const zd_inputs *inputs, double *to)
{
    for (int k = 0; inputs && k < inputs->places; k++)
        if (inputs->place[k].is_speed) memcpy(to, inputs->place[k].place, 3 * sizeof *to), to += 3;
}

static void create_jump(zd_held_inputs *held, zd_arena *arena, const zd_motion *motion)
{
    const size_t m = zd_constraints(&motion->system);
    held->jump.impulses = zd_arena_doubles(arena, m);
    held->jump.works = zd_arena_doubles(arena, m);
    held->start = zd_state_create(arena, motion);
    held->rhs = zd_arena_doubles(arena, m);
    held->x = zd_arena_doubles(arena, motion->system.nv);
}

zd_held_inputs zd_inputs_create(zd_arena *arena, const zd_inputs *inputs, const zd_motion *motion)
{
    const size_t count = inputs ? inputs->count : 0;
    zd_held_inputs held = {.value = zd_arena_doubles(arena, count), .has_changed = zd_arena_bytes(arena, count)};
    held.before.place = zd_arena_doubles(arena, 3 * count_speeds(inputs));
    if (inputs && inputs->jumps) create_jump(&held, arena, motion);
    if (held.value && count) memcpy(held.value, inputs->value, count * sizeof(double));
    if (held.before.place) keep_speeds(inputs, held.before.place);
    return held;
}

static size_t count_numbers(const zd_input_slot *place) { return place->is_speed ? 3 : 1; }

size_t zd_inputs_numbers(const zd_inputs *inputs)
{
    size_t count = 0;
    for (int k = 0; inputs && k < inputs->places; k++) count += count_numbers(inputs->place + k);
    return count;
}

void zd_inputs_save(const zd_inputs *inputs, double *to)
{
    for (int k = 0; inputs && k < inputs->places; k++) {
        memcpy(to, inputs->place[k].place, count_numbers(inputs->place + k) * sizeof *to);
        to += count_numbers(inputs->place + k);
    }
}

void zd_inputs_restore(const zd_inputs *inputs, const double *from)
{
    for (int k = 0; inputs && k < inputs->places; k++) {
        memcpy(inputs->place[k].place, from, count_numbers(inputs->place + k) * sizeof *from);
        from += count_numbers(inputs->place + k);
    }
    if (inputs) zd_inputs_derive(inputs);
}

static int is_refused(const zd_inputs *inputs)
{
    for (int i = 0; i < inputs->count; i++)
        if (!isfinite(inputs->value[i]) || inputs->value[i] < inputs->lower[i] || inputs->value[i] > inputs->upper[i]) return 1;
    return 0;
}

/* Sets a speed: constant, or from the present one to the input over a step of size h. */
static void set_speed(double *place, double t, double speed, double h)
{
    const double now = place[0] + place[1] * (t - place[2]);
    place[0] = h > 0 ? now : speed;
    place[1] = h > 0 ? (speed - now) / h : 0;
    place[2] = t;
}

/* Writes the inputs to their places; speeds follow them over a time h, or jump to them if it is 0. */
static void write(const zd_run *run, double h)
{
    const zd_inputs *inputs = run->settings.inputs;
    for (const zd_input_slot *place = inputs->place; place < inputs->place + inputs->places; place++) {
        const double value = run->held.value[place->input];
        if (place->is_speed) set_speed(place->place, run->stepper.t, value, h);
        else *place->place = value;
    }
    zd_inputs_derive(inputs);
}

int zd_inputs_read(zd_run *run)
{
    const zd_inputs *inputs = run->settings.inputs;
    if (!inputs) return ZD_DONE;
    const size_t bytes = inputs->count * sizeof(double);
    if (is_refused(inputs)) return ZD_BAD_INPUT;       /* also a first value, and a restored one */
    if (!memcmp(run->held.value, inputs->value, bytes)) return ZD_DONE;
    if (!run->held.is_new) memset(run->held.has_changed, 0, inputs->count);
    for (int i = 0; i < inputs->count; i++) run->held.has_changed[i] |= run->held.value[i] != inputs->value[i];
    memcpy(run->held.value, inputs->value, bytes);
    run->held.has_ramp = zd_inputs_have_speeds(inputs) && !inputs->jumps && inputs->ramp == 0;
    run->held.is_new = 1;
    return ZD_DONE;
}

void zd_inputs_write(zd_run *run)
{
    write(run, 0);
    run->held.is_new = 0;
}

/* ---- speeds over several steps ---- */

static int is_followed(const zd_input_slot *place) { return place->is_speed && place->place[1] != 0; }

/* s: end of the ramp of a speed */
static double end_of(const zd_inputs *inputs, const zd_input_slot *place) { return place->place[2] + inputs->ramp; }

/* s: time at which the next ramp ends; INFINITY: none */
static double next_end(const zd_run *run)
{
    const zd_inputs *inputs = run->settings.inputs;
    double end = INFINITY;
    for (const zd_input_slot *place = inputs->place; place < inputs->place + inputs->places; place++)
        if (is_followed(place)) end = fmin(end, end_of(inputs, place));
    return end;
}

/* Ends ramps at this time, and begins those of inputs that changed. Returns true if anything is written. */
static int follow(const zd_run *run)
{
    const zd_inputs *inputs = run->settings.inputs;
    const double t = run->stepper.t;
    int is_written = 0;
    for (const zd_input_slot *place = inputs->place; place < inputs->place + inputs->places; place++) {
        const int begins = run->held.is_new && run->held.has_changed[place->input], ends = is_followed(place) && t >= end_of(inputs, place);
        const double value = run->held.value[place->input];
        if (!place->is_speed) *place->place = value;
        else if (begins || ends) set_speed(place->place, t, value, begins ? inputs->ramp : 0);
        is_written |= ends;
    }
    zd_inputs_derive(inputs);
    return is_written || run->held.is_new;
}

/* ---- a step ---- */

static void keep(zd_run *run)
{
    zd_held_inputs *held = &run->held;
    keep_speeds(run->settings.inputs, held->before.place);
    held->before.is_new = held->is_new;
    held->before.has_ramp = held->has_ramp;
    held->before.jumps = held->jump.count;
}

void zd_inputs_return(zd_run *run)
{
    const zd_inputs *inputs = run->settings.inputs;
    zd_held_inputs *held = &run->held;
    const double *from = held->before.place;
    if (!zd_inputs_have_speeds(inputs)) return;
    for (int k = 0; k < inputs->places; k++)
        if (inputs->place[k].is_speed) memcpy(inputs->place[k].place, from, 3 * sizeof *from), from += 3;
    held->is_new = held->before.is_new;
    held->has_ramp = held->before.has_ramp;
    held->jump.count = held->before.jumps;
    zd_inputs_derive(inputs);
}

static int speeds_have_changed(const zd_run *run)
{
    const zd_inputs *inputs = run->settings.inputs;
    for (int k = 0; k < inputs->places; k++)
        if (inputs->place[k].is_speed && run->held.has_changed[inputs->place[k].input]) return 1;
    return 0;
}

/* True if speeds follow inputs beyond this time, in a fixed step that an event has cut. */
static int have_speeds_to_follow(const zd_run *run)
{
    const zd_inputs *inputs = run->settings.inputs;
    const double h = run->settings.step;
    for (const zd_input_slot *place = inputs->place; place < inputs->place + inputs->places; place++)
        if (is_followed(place) && run->stepper.t < place->place[2] + (1 - MIN_STEP_SHARE) * h) return 1;
    return 0;
}

/* Writes what is new at the start of a step, and makes the jump of speeds, if any. */
static int begin(zd_run *run)
{
    const zd_inputs *inputs = run->settings.inputs;
    zd_held_inputs *held = &run->held;
    if (!held->is_new && have_speeds_to_follow(run)) return ZD_DONE;
    const int jumps = inputs->jumps && held->is_new && speeds_have_changed(run);
    int status = jumps ? zd_jump_begin(run) : ZD_DONE;
    if (status) return status;
    write(run, held->is_new && !inputs->jumps ? run->settings.step : 0);
    if (!held->is_new) held->has_ramp = 0;
    held->is_new = 0;
    return jumps ? zd_jump_finish(run) : zd_renew(&run->loop);
}

int zd_inputs_begin_step(zd_run *run)
{
    const zd_inputs *inputs = run->settings.inputs;
    zd_held_inputs *held = &run->held;
    keep(run);
    if (inputs->ramp == 0 || inputs->jumps) return held->is_new || held->has_ramp ? begin(run) : ZD_DONE;
    const int is_written = follow(run);
    run->loop.limit = next_end(run);
    if (is_written) held->is_new = 0;
    return is_written ? zd_renew(&run->loop) : ZD_DONE;
}
