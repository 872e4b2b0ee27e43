#include "opened.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "../../workspace.h"
#include "../block.h"
#include "../made.h"
#include "opened_memory.h"

enum { MESSAGE = ZD_OPENED_MESSAGE };
static const double SPAN = 1;       /* s: time scale of the checks of the start */

static zd_opened *create(zd_arena *arena, const zd_block *block)
{
    const zd_system *system = zd_block_system(block);
    zd_opened nowhere, *here = zd_arena_bytes(arena, sizeof *here), *self = here ? here : &nowhere;
    self->p = zd_arena_doubles(arena, system->nq);
    self->v = zd_arena_doubles(arena, system->nv);
    const int of_measures = system->measures->scratch + system->nv + system->mh + system->mn;
    self->scratch = zd_arena_doubles(arena, of_measures > system->scratch ? of_measures : system->scratch);
    const size_t inputs = zd_block_inputs(block);
    self->initial = zd_arena_doubles(arena, inputs);
    self->present = zd_arena_doubles(arena, inputs);
    self->places = zd_arena_doubles(arena, ZD_OPENED_PLACE * inputs);
    return here;
}

static zd_opened *allocate(const zd_block *block)
{
    zd_arena counting = {.used = 0};
    create(&counting, block);
    zd_arena arena = {.base = zd_allocate(counting.used)};
    return arena.base ? create(&arena, block) : NULL;
}

typedef int zd_opened_first(zd_opened *self, double t, const double *p, const double *v);

static zd_opened *open_run(zd_block *block, double t, zd_opened_first *begin, char *message, int size)
{
    const double *start = zd_block_start(block);
    zd_opened *self = start ? allocate(block) : NULL;
    if (!self) {
        snprintf(message, size, start ? "memory for the run was not allocated" : "the block must have a start");
        return NULL;
    }
    self->block = block;
    int status = zd_block_settings(block, &self->settings, self->message, MESSAGE);
    self->settings.is_open = 1;
    if (!status) status = begin(self, t, start, start + zd_block_system(block)->nq);
    if (!status) return self;
    zd_block_explain_start(block, self->message, MESSAGE);
    snprintf(message, size, "%s", self->message);
    zd_release(self);
    return NULL;
}

static zd_opened *open_block(const void *data, size_t size, double t, zd_opened_first *begin, char *message, int message_size)
{
    zd_block *block = zd_block_create(data, size, message, message_size);
    zd_opened *self = block ? open_run(block, t, begin, message, message_size) : NULL;
    if (block && !self) zd_block_free(block);
    return self;
}

zd_opened *zd_opened_create(const void *data, size_t size, double t, char *message, int message_size)
{
    return open_block(data, size, t, zd_opened_restart, message, message_size);
}

zd_opened *zd_opened_create_assembled(const void *data, size_t size, double t, char *message, int message_size)
{
    return open_block(data, size, t, zd_opened_assemble, message, message_size);
}

void zd_opened_free(zd_opened *self)
{
    if (!self) return;
    zd_run_free(self->run);
    zd_block_free(self->block);
    zd_release(self);
}

zd_block *zd_opened_block(const zd_opened *self) { return self->block; }
const zd_run *zd_opened_run(const zd_opened *self) { return self->run; }
const char *zd_opened_message(const zd_opened *self) { return self->message; }
void zd_opened_watch(zd_opened *self, const zd_events *events) { self->settings.events = events; }

int zd_opened_settings(zd_opened *self, double t, zd_settings *settings)
{
    if (zd_block_settings(self->block, settings, self->message, MESSAGE)) return ZD_BAD_ARGUMENT;
    *settings = self->settings;
    settings->t0 = t;
    settings->t1 = t + SPAN;
    return ZD_DONE;
}

int zd_opened_restart(zd_opened *self, double t, const double *p, const double *v)
{
    int status;
    zd_settings settings;
    if (zd_opened_settings(self, t, &settings)) return ZD_BAD_ARGUMENT;
    zd_run *run = zd_run_create(zd_block_system(self->block), &settings, p, v, &status, self->message, MESSAGE);
    if (!run) return status;
    zd_run_free(self->run);
    self->run = run;
    return ZD_DONE;
}

int zd_opened_assemble(zd_opened *self, double t, const double *p, const double *v)
{
    const zd_system *system = zd_block_system(self->block);
    memmove(self->p, p, system->nq * sizeof *p);
    memcpy(self->v, v, system->nv * sizeof *v);
    signed char *state = zd_allocate(system->groups + 1);
    for (int g = 0; state && g < system->groups; g++) state[g] = system->group[g].kind != ZD_FRICTION && system->group[g].is_active;
    zd_system *phase = state ? zd_phase_new(system, state) : NULL;
    const zd_system *of = system->groups ? phase : system;
    zd_settings settings = self->settings;
    settings.events = NULL;     /* their actions may be on groups */
    const int status = !phase ? ZD_NO_MEMORY
                     : zd_project(of, &settings, t, self->p, self->v, NULL, NULL, NULL, self->message, MESSAGE);
    zd_phase_free(phase);
    zd_release(state);
    return status ? status : zd_opened_restart(self, t, self->p, self->v);
}

/* Joints that may be released are joined at the start of the block, and contacts closed, as in a run; without a run, as at the start of
 * another block. */
static void set_joined(zd_block *block, const zd_run *run, const zd_block *other)
{
    const zd_transition *last = run ? zd_run_transition(run) : NULL;
    zd_group *group = (zd_group *)block->system.group;
    for (int g = 0; g < block->system.groups; g++) group[g].is_active = last ? last->state[g] == 1 : other->system.group[g].is_active;
}

/* Takes the place of the present block, whose number of coordinates is the same, at its state; on failure the present one stays. */
static int replace(zd_opened *self, zd_block *block)
{
    const zd_opened before = *self;
    const double t = zd_run_time(self->run);
    for (int i = 0; i < zd_block_inputs(block); i++) zd_block_set_input(block, i, zd_block_input(self->block, i));
    self->block = block;
    self->run = NULL;
    int status = zd_block_settings(block, &self->settings, self->message, MESSAGE);
    self->settings.is_open = 1;
    set_joined(block, before.run, before.block);
    if (!status) status = zd_opened_assemble(self, t, zd_run_p(before.run), zd_run_v(before.run));
    if (status && !zd_opened_find_positions(self, t, zd_run_p(before.run)))
        status = zd_opened_assemble(self, t, self->p, zd_run_v(before.run));
    set_joined(block, NULL, before.block);
    if (status) {
        zd_block_explain_start(block, self->message, MESSAGE);
        self->block = before.block;
        self->run = before.run;
        self->settings = before.settings;
        return status;
    }
    zd_run_free(before.run);
    zd_block_free(before.block);
    return ZD_DONE;
}

int zd_opened_set_parameter(zd_opened *self, int parameter, double value)
{
    const double present = zd_block_parameter(self->block, parameter);
    size_t size;
    if (zd_block_set_parameter(self->block, parameter, value)) {
        snprintf(self->message, MESSAGE, "the parameter must exist, and its value be in its range");
        return ZD_BAD_ARGUMENT;
    }
    const double *words = zd_block_words(self->block, &size);
    zd_block *block = zd_block_create(words, size, self->message, MESSAGE);
    const int status = block ? replace(self, block) : ZD_BAD_ARGUMENT;
    if (!status) return ZD_DONE;
    if (block) zd_block_free(block);
    zd_block_set_parameter(self->block, parameter, present);
    return status;
}

/* Advances to the goal that was set. */
static int advance(zd_opened *self, int status)
{
    const int is_refused = status;
    if (!is_refused) do status = zd_run_advance(self->run, NULL, SPAN);
    while (status == ZD_PAUSED);
    if (status) snprintf(self->message, MESSAGE, "%s", status == ZD_BAD_ARGUMENT ? "the time must not be before the present one" :
                         status == ZD_BAD_INPUT ? "inputs must be finite" : zd_run_message(self->run));
    if (status < 0 && !is_refused) zd_opened_explain_reach(self);
    return status;
}

int zd_opened_step(zd_opened *self, double steps)
{
    if (!(steps >= 0 && steps < 0x1p53)) return advance(self, ZD_BAD_ARGUMENT);
    return advance(self, zd_run_set_goal(self->run, (int64_t)steps, INFINITY));
}

int zd_opened_advance(zd_opened *self, double t)
{
    return advance(self, isfinite(t) ? zd_run_set_goal(self->run, INT64_MAX, t) : ZD_BAD_ARGUMENT);
}

int zd_opened_measure(zd_opened *self, int measure, double *value)
{
    const zd_system *system = zd_block_system(self->block);
    if (measure < 0 || measure >= system->measures->count) return ZD_BAD_ARGUMENT;
    return zd_run_measure(self->run, system, measure, zd_run_time(self->run), zd_run_p(self->run), zd_run_v(self->run), value, self->scratch);
}

void zd_opened_poses(zd_opened *self, double *poses) { zd_block_poses(self->block, zd_run_p(self->run), poses, self->scratch); }

double zd_opened_violation(zd_opened *self)
{
    double violation;
    return zd_run_position_violation(self->run, &violation) ? NAN : violation;
}

double zd_opened_energy_violation(zd_opened *self)
{
    double violation;
    return zd_run_energy_violation(self->run, &violation) ? NAN : violation;
}

int zd_opened_outputs(zd_opened *self, double *value)
{
    const zd_measures *measures = zd_block_system(self->block)->measures;
    const zd_outputs *outputs = self->settings.outputs;
    for (int i = 0; outputs && i < outputs->count; i++) {
        const int status = zd_opened_measure(self, outputs->measure[i], value);
        if (status) return status;
        value += measures->measure[outputs->measure[i]].size;
    }
    return ZD_DONE;
}
