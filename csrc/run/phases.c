/* A run has the components of its present phase; those of the others are copies, at the address of which only these are used again. So all
 * addresses in them are right while they are in place, and entering a phase that has been seen costs a copy.
 */
#include "phases.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "../paths/path.h"
#include "../point/point.h"
#include "../registry.h"

static const double SAME_INSTANT = 1e-13;   /* time between two events, relative to the time, that is rounding */
static const double PASSED_GAP = 1e-6;      /* gap beyond a contact, relative to its scale, that is beyond rounding */
static const double MARGIN_ROUNDING = 1e-15;    /* gap, relative to its scale, that is rounding */

/* ---- creation ---- */

/* Events of a run that groups are part of: those of the user, then one for each group. */
static int evaluate_event(void *data, int event, double t, const double *p, const double *v, const double *x, double *value)
{
    const zd_events *own = ((const zd_phases *)data)->own;
    return own->evaluate(own->data, event, t, p, v, x, value);
}

static int found_event(void *data, int event, double t, const double *p, const double *v)
{
    const zd_events *own = ((const zd_phases *)data)->own;
    return own && own->found && event < own->count ? own->found(own->data, event, t, p, v) : ZD_DONE;
}

typedef struct making {
    const zd_system *full;
    const zd_settings *settings;
} making;

static void add_events(zd_phases *self, zd_arena *arena)
{
    static const zd_events none = {0};
    const zd_events *own = self->own ? self->own : &none;
    const int groups = self->full->groups, count = own->count + groups, actions = own->actions + groups;
    int *direction = zd_arena_ints(arena, count), *terminal = zd_arena_ints(arena, count);
    zd_event *known = zd_arena_bytes(arena, count * sizeof *known);
    zd_action *action = zd_arena_bytes(arena, actions * sizeof *action);
    zd_argument *reading = zd_arena_bytes(arena, groups * sizeof *reading);
    if (!arena->base) return;
    for (int i = 0; i < own->count; i++) {
        direction[i] = own->direction[i], terminal[i] = own->terminal[i];
        if (own->known) known[i] = own->known[i];
    }
    if (own->actions) memcpy(action, own->action, own->actions * sizeof *action);
    for (int g = 0; g < groups; g++) {
        reading[g] = (zd_argument){.what = ZD_READS_GROUP, .index = g};
        known[own->count + g] = (zd_event){.readings = 1, .reading = reading + g};
        direction[own->count + g] = -1;
        action[own->actions + g] = (zd_action){own->count + g, ZD_CHANGES_PHASE, 0};
    }
    self->events = (zd_events){count, direction, terminal, known, actions, action, own->of ? own->of : self->full, self, evaluate_event,
                               found_event};
    self->settings.events = &self->events;
}

static void *make(zd_arena *arena, const void *of)
{
    const making *it = of;
    const zd_system *full = it->full;
    zd_phases nowhere, *here = zd_arena_bytes(arena, sizeof *here), *self = here ? here : &nowhere;
    *self = (zd_phases){.full = full, .settings = *it->settings, .own = it->settings->events};
    self->outputs = it->settings->outputs ? *it->settings->outputs : (zd_outputs){0};
    if (it->settings->outputs && !self->outputs.of) self->outputs.of = full;
    if (it->settings->outputs) self->settings.outputs = &self->outputs;
    self->length = full->length > 0 ? full->length : 1;
    self->at = (zd_state){.p = zd_arena_doubles(arena, full->nq), .v = zd_arena_doubles(arena, full->nv)};
    self->state = zd_arena_bytes(arena, full->groups);
    self->occurs = zd_arena_ints(arena, self->own ? self->own->count : 0);
    self->passed = zd_arena_doubles(arena, self->own ? self->own->count : 0);
    for (int g = 0; self->state && g < full->groups; g++)
        self->state[g] = full->group[g].kind == ZD_TWO_SIDED && full->group[g].is_active ? ZD_CLOSED : ZD_OPEN;
    self->last.state = self->state;
    self->last.impulse = zd_arena_doubles(arena, full->groups);
    self->last.loss = zd_arena_doubles(arena, full->groups);
    self->offset = zd_arena_doubles(arena, full->mh);
    self->size = zd_arena_doubles(arena, full->mh);
    for (int k = 0; self->size && k < full->mh; k++) self->size[k] = 1;
    add_events(self, arena);
    return here;
}

zd_phases *zd_phases_create(const zd_system *full, const zd_settings *settings)
{
    zd_store store = {NULL};
    zd_phases *self = zd_store_create(&store, make, &(making){full, settings});
    if (self) self->store = store;
    return self;
}

typedef struct phase_making {
    const zd_phases *phases;
    const signed char *state;
} phase_making;

static void *make_phase(zd_arena *arena, const void *of)
{
    const phase_making *it = of;
    zd_phase nowhere, *here = zd_arena_bytes(arena, sizeof *here), *self = here ? here : &nowhere;
    self->next = NULL, self->is_open = 0;
    self->plan = zd_arena_bytes(arena, sizeof *self->plan);
    self->of = zd_phase_system_create(arena, it->phases->full, it->state);
    self->opened = zd_arena_doubles(arena, 1 + (size_t)it->phases->full->nq + (size_t)it->phases->full->nv
                                               + zd_inputs_numbers(it->phases->settings.inputs));
    return here;
}

/* Saves images of a phase and of its plan, if it is open; nonzero: out of memory */
static int save_images(zd_phase *phase)
{
    int failed = zd_memory_save(phase->memory);
    if (failed) return ZD_NO_MEMORY;
    ((zd_phase *)(void *)phase->memory->image)->next = NULL;    /* phases may be opened in another order than they were found */
    if (!phase->is_open) return ZD_DONE;
    failed = zd_memory_save(phase->plan->memory);
    for (zd_memory *block = phase->plan->motion.store.last; block && !failed; block = block->previous) failed = zd_memory_save(block);
    return failed ? ZD_NO_MEMORY : ZD_DONE;
}

zd_phase *zd_phases_find(zd_phases *self, const signed char *state)
{
    zd_phase **last = &self->first;
    for (; *last; last = &(*last)->next)
        if (!memcmp((*last)->of->state, state, self->full->groups)) return *last;
    zd_phase *phase = zd_store_create(&self->store, make_phase, &(phase_making){self, state});
    if (!phase) return NULL;
    phase->memory = self->store.last;
    if (self->has_images && save_images(phase)) return NULL;
    return *last = phase;
}

void zd_phases_free(zd_run *run)
{
    zd_phases *self = run->phases;
    zd_memory *of_run = NULL;
    zd_store store = self->store;
    *self->present->plan = *run;
    for (zd_phase *phase = self->first; phase; phase = phase->next) {
        if (!phase->is_open) continue;
        zd_store_release(&phase->plan->motion.store);
        if (phase == self->first) of_run = phase->plan->memory;     /* the run itself is in it */
        else zd_memory_free(phase->plan->memory);
    }
    zd_memory_free(run->start);
    zd_memory_free(of_run);
    zd_store_release(&store);
}

/* ---- a change of the plan ---- */

void zd_phases_save_state(zd_run *run)
{
    zd_phases *self = run->phases;
    const zd_motion *motion = &run->motion;
    self->at.t = run->stepper.t;
    zd_copy_all(motion->system.nq, motion->point->p, self->at.p);
    zd_copy_all(motion->system.nv, motion->point->v, self->at.v);
    self->input = zd_motion_input(motion);
    const zd_watch *watch = &run->watch;
    if (self->own) memset(self->occurs, 0, self->own->count * sizeof *self->occurs);
    for (const zd_occurrence *it = watch->occurrence; it < watch->occurrence + watch->occurrences; it++)
        if (self->own && it->event < self->own->count && self->at.t - it->bracket.b <= SAME_INSTANT * fabs(self->at.t))
            self->occurs[it->event] = 1;
}

/* Passes on all that a change of the phase leaves as it is. */
static void pass_on(zd_run *to, const zd_run *from)
{
    const zd_control *control = &from->loop.control;
    const zd_held_inputs own = to->held;
    double *scale = to->loop.control.scale;
    const int64_t rank = to->motion.statistics.rank;
    to->start = from->start, to->phases = from->phases, to->tally = from->tally, to->outcome = from->outcome;
    to->goal.step = from->goal.step, to->goal.end = from->goal.end;
    to->motion.statistics = from->motion.statistics;
    to->motion.statistics.rank = rank;
    to->motion.balance.initial = from->motion.balance.initial, to->motion.balance.jump = from->motion.balance.jump;
    to->loop.step = from->loop.step, to->loop.steps = from->loop.steps;
    to->loop.t_begin = from->loop.t_begin, to->loop.steps_before = from->loop.steps_before;
    to->loop.end = from->loop.end, to->loop.limit = from->loop.limit, to->loop.before_break = from->loop.before_break;
    to->loop.parts = to->loop.part = 0;
    to->loop.control = *control;
    to->loop.control.scale = scale;
    to->held = from->held;
    to->held.start = own.start, to->held.rhs = own.rhs, to->held.x = own.x;
    to->held.jump.impulses = own.jump.impulses, to->held.jump.works = own.jump.works;
    to->output.next = from->output.next, to->output.is_waiting = from->output.is_waiting;
    to->output.is_open = to->output.is_prepared = to->output.is_within = 0;
    to->safeguards.guard.kinetic = from->safeguards.guard.kinetic;
    to->safeguards.guard.largest_fourth = from->safeguards.guard.largest_fourth;
    if (!to->watch.events) return;
    to->watch.ended = from->watch.ended, to->watch.next_action = from->watch.next_action, to->watch.calls = from->watch.calls;
    memcpy(to->watch.found, from->watch.found, to->watch.events->count * sizeof *to->watch.found);
    memcpy(to->watch.acts, from->watch.acts, to->watch.events->count * sizeof *to->watch.acts);
    memcpy(to->watch.acted, from->watch.acted, 2 * to->watch.events->count * sizeof *to->watch.acted);
}

static void note_opening(const zd_phases *self, double *opened)
{
    *opened = self->at.t;
    zd_copy_all(self->full->nq, self->at.p, opened + 1);
    zd_copy_all(self->full->nv, self->at.v, opened + 1 + self->full->nq);
    zd_inputs_save(self->settings.inputs, opened + 1 + self->full->nq + self->full->nv);
}

int zd_phase_open(zd_run *run, zd_phase *to, const zd_run *before)
{
    zd_phases *self = before->phases;
    note_opening(self, to->opened);
    int status;
    char message[ZD_MESSAGE] = "";
    zd_run *opened = zd_run_open(run, &to->of->system, &self->settings, self->at.t, self->at.p, self->at.v, &status, message, ZD_MESSAGE);
    if (opened && !status && zd_output_interpolates(&run->output)) status = zd_dense_output_create(&run->stepper);
    if (!opened || status) {
        if (opened) zd_plan_free(run);
        *run = *before;
        snprintf(run->outcome.message, sizeof run->outcome.message, "%s", message);
        return status ? status : ZD_NO_MEMORY;
    }
    run->phases = self;
    run->start = before->start;
    zd_phase_use(run, to);
    *to->plan = *run;
    return self->has_images ? save_images(to) : ZD_DONE;
}

void zd_phase_use(zd_run *run, zd_phase *phase)
{
    zd_phases *self = run->phases;
    phase->is_open = 1;
    self->present = phase;
    run->motion.point->phase = phase->of;
}

int zd_phases_suit(const zd_system *full, int integrator)
{
    zd_system sticking = *full;
    for (int g = 0; g < full->groups; g++) sticking.mn |= full->group[g].kind == ZD_FRICTION;
    return !full->groups || zd_suits(&sticking, integrator);
}

void zd_phases_attach(zd_run *run, zd_phases *phases)
{
    run->phases = phases;
    zd_phase_use(run, phases->first);
}

const double *zd_phases_sizes(const zd_run *run)
{
    const zd_phases *self = run->phases;
    const zd_phase_system *of = self->present->of;
    for (int k = 0; k < run->motion.system.mh; k++) self->size[of->row[k]] = run->motion.point->size[k];
    return self->size;
}

/* Moves the run to the state, in the present phase. */
static int start_phase(zd_run *run)
{
    zd_phases *self = run->phases;
    zd_motion *motion = &run->motion;
    int status = zd_variables_use_chosen(&run->stepper);
    for (int i = motion->formulation_size; i < motion->rate.size; i++) run->stepper.y[i] = 0;
    if (motion->balance.input) run->stepper.y[motion->rate.size - 1] = self->input;
    motion->in_run = 1, motion->point->known = 0;
    return status ? status : zd_stepper_set_state(&run->stepper, self->at.t, self->at.p, self->at.v);
}

/* Margins that rounding makes negative begin at zero. */
static int begin_margins(zd_run *run)
{
    zd_phases *self = run->phases;
    zd_phase_system *of = self->present->of;
    const int own = self->own ? self->own->count : 0;
    int status = zd_phase_update_directions(of, 1, self->at.t, self->at.p, self->at.v);
    if (!status) status = zd_motion_accelerate(&run->motion);
    if (!status) zd_rank_find_multipliers(run->motion.point);
    memset(of->bias, 0, self->full->groups * sizeof *of->bias);
    for (int g = 0; !status && g < self->full->groups; g++) {
        double margin;
        status = zd_phase_margin(of, run->motion.point, g, self->at.t, self->at.p, self->at.v, &margin);
        const zd_group *group = self->full->group + g;
        const double rounding = group->rows == 2 && zd_slides(of->state[g]) ? of->slow_slip : MARGIN_ROUNDING * zd_group_scale(self, group);
        if (margin < rounding) of->bias[g] = rounding - margin;
    }
    if (!status) status = zd_watch_start(&run->watch);
    zd_phase_update_turning_slip(of, &run->settings, run->watch.before + own);
    /* Events of the user at the same instant do not occur again as their functions leave zero. */
    for (int i = 0; i < own; i++)
        if (self->occurs[i]) run->watch.before[i] = 0;
    return status;
}

int zd_phase_enter(zd_run *run, const signed char *state, int prepares)
{
    zd_phases *self = run->phases;
    zd_phase *to = zd_phases_find(self, state);
    if (!to) return ZD_NO_MEMORY;
    int status = ZD_DONE;
    if (to != self->present) {
        zd_run *before = self->present->plan;
        *before = *run;
        if (to->is_open) *run = *to->plan, zd_phase_use(run, to);
        else status = zd_phase_open(run, to, before);
        if (status) return status;
        pass_on(run, before);
    }
    for (int k = 0; k < to->of->system.mh; k++)
        if (to->of->keeps_value[k]) to->of->value[k] = self->offset[to->of->row[k]];
    status = start_phase(run);
    if (status || prepares) return status;
    status = zd_start_check(run, run->motion.point->rhs);
    if (!status) status = begin_margins(run);
    zd_switching_release(&run->loop);
    if (!status) status = zd_renew(&run->loop);
    return status ? status : zd_safeguards_begin(&run->safeguards, run->loop.step + 1);
}

int zd_phases_place(zd_run *run, const signed char *state, double t, const double *p, const double *v, double input)
{
    zd_phases *self = run->phases;
    self->at.t = t;
    self->input = input;
    zd_copy_all(self->full->nq, p, self->at.p);
    zd_copy_all(self->full->nv, v, self->at.v);
    return zd_phase_enter(run, state, 1);
}

int zd_phases_check(zd_run *run)
{
    const zd_phases *self = run->phases;
    const int own = self->own ? self->own->count : 0;
    zd_phase_forget(self->present->of);
    for (int g = 0; g < self->full->groups && !run->watch.ended; g++) {
        const zd_group *group = self->full->group + g;
        const double gap = run->watch.before[own + g];
        if (group->kind != ZD_ONE_SIDED || self->state[g] != ZD_OPEN || gap > -PASSED_GAP * zd_group_scale(self, group)) continue;
        snprintf(run->outcome.message, sizeof run->outcome.message, "a step must not pass contact '%s', and ended %.3g beyond it: "
                 "set max_step or a shorter step", group->name, -gap);
        return ZD_BRANCH;
    }
    zd_phase_update_turning_slip(self->present->of, &run->settings, run->watch.before + own);
    return zd_phase_update_directions(self->present->of, 0, run->stepper.t, run->motion.point->p, run->motion.point->v);
}
