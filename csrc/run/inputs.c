/* Inputs are constant within a step, except speeds: these follow an input linearly over one step, so that velocities do not jump. A change
 * makes what is known at the start of the step invalid; without a change nothing is done, and the bits are those of a run without inputs.
 * Reactions and accelerations that user functions read are inputs, too, which are read from the accepted state before each step.
 */
#include "inputs.h"

#include <math.h>
#include <string.h>

#include "../constraints/rank.h"

zd_held_inputs zd_inputs_take(zd_arena *arena, const zd_inputs *inputs)
{
    const size_t count = inputs ? (size_t)inputs->count : 0, measures = inputs ? (size_t)inputs->measures : 0;
    zd_held_inputs held = {.value = zd_take_doubles(arena, count + measures)};
    if (measures) {
        held.measured = zd_take_doubles(arena, (size_t)zd_largest_measure(inputs->of->measures));
        held.scratch = zd_take_doubles(arena, (size_t)inputs->of->measures->scratch);
    }
    if (held.value && count) memcpy(held.value, inputs->value, count * sizeof(double));
    return held;
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

/* Writes the inputs to their places. */
static void write(const zd_run *run, double h)
{
    const zd_inputs *inputs = run->settings.inputs;
    for (const zd_input_place *place = inputs->place; place < inputs->place + inputs->places; place++) {
        const double value = run->held.value[place->input];
        if (place->is_speed) set_speed(place->place, run->stepper.t, value, h);
        else *place->place = value;
    }
    for (int i = 0; i < inputs->derivations; i++) inputs->derive[i](inputs->data[i]);
}

/* Recomputes what is known at the present point and depends on inputs. */
static int renew(zd_run *run)
{
    zd_motion *motion = &run->motion;
    zd_guard *guard = &run->safeguards.guard;
    const int was_accelerated = motion->point->known & ZD_ACCELERATED;
    motion->point->known &= motion->point->constant;
    if (!motion->path.continues && !guard->watches_step && !was_accelerated) return ZD_DONE;
    const int status = zd_motion_accelerate(motion);
    if (!status && guard->watches_step) zd_guard_watch_next(guard);
    return status;
}

static int has_speeds(const zd_inputs *inputs)
{
    for (int k = 0; k < inputs->places; k++)
        if (inputs->place[k].is_speed) return 1;
    return 0;
}

int zd_inputs_read(zd_run *run)
{
    const zd_inputs *inputs = run->settings.inputs;
    if (!inputs) return ZD_DONE;
    const size_t bytes = (size_t)inputs->count * sizeof(double);
    if (!memcmp(run->held.value, inputs->value, bytes)) return ZD_DONE;
    if (is_refused(inputs)) return ZD_BAD_INPUT;
    memcpy(run->held.value, inputs->value, bytes);
    run->held.has_ramp = has_speeds(inputs);
    run->held.is_new = 1;
    return ZD_DONE;
}

void zd_inputs_write(zd_run *run)
{
    write(run, 0);
    run->held.is_new = 0;
}

/* Reads the measures of the accepted state, once before each step, also before one that is made again after a failure. */
static int read_measures(zd_run *run, int *have_changed)
{
    const zd_inputs *inputs = run->settings.inputs;
    zd_held_inputs *held = &run->held;
    const zd_point *point = run->motion.point;
    if (!inputs->measures || held->measured_step == run->loop.step + 1) return ZD_DONE;
    int status = zd_motion_accelerate(&run->motion);
    if (status) return status;
    zd_rank_find_multipliers(run->motion.point);
    for (int i = 0; i < inputs->measures; i++) {
        const zd_measured out = {.value = held->measured};
        double *value = held->value + inputs->count + i;
        const zd_measures *measures = inputs->of->measures;
        if (measures->evaluate(inputs->of->data, point->terms.inputs, inputs->measure[i].measure, point->t, point->p, point->v, point->vdot,
                               point->lambda, &out, held->scratch)) return ZD_CALLBACK;
        *have_changed |= *value != held->measured[inputs->measure[i].component];
        *value = held->measured[inputs->measure[i].component];
    }
    held->measured_step = run->loop.step + 1;
    return ZD_DONE;
}

int zd_inputs_begin_step(zd_run *run)
{
    zd_held_inputs *held = &run->held;
    int have_changed = 0;
    const int status = read_measures(run, &have_changed);
    if (status) return status;
    if (!held->is_new && !held->has_ramp && !have_changed) return ZD_DONE;
    write(run, held->is_new ? run->settings.step : 0);
    if (!held->is_new) held->has_ramp = 0;
    held->is_new = 0;
    return renew(run);
}
