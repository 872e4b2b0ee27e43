/* Lanes of a batch: allocation, and numbers at the start of a run. */
#include <math.h>

#include "../output/reading.h"
#include "../paths/path.h"
#include "../step_limits.h"
#include "group.h"

static zd_weights without_zeros(int count, const double *weight)
{
    zd_weights weights = {0};
    for (int j = 0; weight && j < count; j++) {
        if (weight[j] == 0) continue;
        weights.stage[weights.count] = j;
        weights.weight[weights.count++] = weight[j];
    }
    return weights;
}

static zd_method method_of(const zd_integrator *integrator)
{
    const zd_tableau *T = integrator->table;
    const int stages = T->stages, all = stages + 1 + T->more;
    zd_method method = {.tableau = T, .stages = stages, .error_order = integrator->card.error_order};
    for (int i = 0; i < stages; i++) method.a[i] = without_zeros(i, T->a + i * stages);
    method.b = without_zeros(stages, T->b);
    method.e = without_zeros(stages + 1, T->e);
    method.e3 = without_zeros(stages + 1, T->e3);
    for (int i = 0; i < T->more; i++) method.more[i] = without_zeros(all, T->more_a + i * all);
    for (int i = 0; i < T->coefficients - 3; i++) method.d[i] = without_zeros(all, T->d + i * all);
    return method;
}

static const zd_lane_functions *const all[] = {&zd_lanes_baseline, &zd_lanes_avx2, &zd_lanes_avx512};    /* by zd_unit */

int zd_lanes_of_unit(enum zd_unit unit)
{
    return all[unit]->lanes;
}

const zd_lane_functions *zd_lane_functions_of(const zd_system *system, enum zd_unit unit, const zd_closed_form **closed_form)
{
    const zd_lane_functions *functions = all[unit];
    for (int i = 0; i < system->closed_forms && functions->lanes; i++) {
        *closed_form = system->closed_form + i;
        if ((*closed_form)->unit == unit && (*closed_form)->lanes == functions->lanes) return functions;
    }
    return NULL;
}

/* Allocates `count` numbers per lane; all are contiguous, from self->first on. */
static double *allocate(zd_lanes *self, zd_arena *arena, int64_t count)
{
    double *here = zd_arena_doubles(arena, count * self->lanes);
    if (!self->first) self->first = here;
    return here;
}

static void create_zeros(zd_lanes *self, zd_arena *arena)
{
    double **const ones[] = {&self->number, &self->after_rejection, &self->streak, &self->iterations, &self->rejected, &self->peak_iterations,
                             &self->leaves, &self->is_long, &self->check_soon, &self->last_checked, &self->at_limit, &self->below_limit,
                             &self->stiff, &self->fastest, &self->has_event, &self->is_wanted, &self->next_number, &self->unresolved,
                             &self->unresolved_time, &self->part_error, &self->part, &self->power};
    double **const parts[] = {&self->error, &self->path, &self->place, &self->lowest, &self->highest};
    const int count = sizeof ones / sizeof ones[0], count_parts = sizeof parts / sizeof parts[0], nv = self->is_fixed ? self->nv : 0;
    self->numbers_from_zero = count + count_parts * nv;
    self->from_zero = allocate(self, arena, self->numbers_from_zero);
    if (!self->from_zero) return;
    for (int i = 0; i < count; i++) *ones[i] = self->from_zero + i * self->lanes;
    for (int i = 0; i < count_parts; i++) *parts[i] = self->from_zero + (count + i * nv) * self->lanes;
}

static void create_states(zd_lanes *self, zd_arena *arena, int64_t doubles, int inputs)
{
    const int nq = self->nq, nv = self->nv, size = self->size;
    double **const ones[] = {&self->is_active, &self->t, &self->h, &self->next_t, &self->t_before, &self->order, &self->speed,
                             &self->is_corrected, &self->next_check, &self->check_pause, &self->t_sample};
    self->data = allocate(self, arena, doubles);
    self->inputs = inputs ? allocate(self, arena, 2 * inputs + 1) : NULL;
    create_zeros(self, arena);
    for (size_t i = 0; i < sizeof ones / sizeof ones[0]; i++) *ones[i] = allocate(self, arena, 1);
    self->y = allocate(self, arena, size);
    self->y0 = allocate(self, arena, size);
    self->pdot = allocate(self, arena, nq);
    self->vdot = allocate(self, arena, nv);
    self->pivots = allocate(self, arena, nv);
    self->inverse_unit_p = allocate(self, arena, nq);
    self->inverse_unit = allocate(self, arena, nv);
    self->allowed = allocate(self, arena, self->mh);
    self->inverse_size = allocate(self, arena, self->mh);
    self->scale = allocate(self, arena, (int64_t)self->closed_form->orders * nv);
}

static void create_workspace(zd_lanes *self, zd_arena *arena)
{
    const int nq = self->nq, nv = self->nv, m = self->m, size = self->size;
    const zd_tableau *T = self->method.tableau;
    self->y_sample = allocate(self, arena, size);
    self->lambda_sample = allocate(self, arena, m);
    self->k = allocate(self, arena, (int64_t)(T->stages + 1 + T->more) * size);
    self->stage = allocate(self, arena, size);
    self->y1 = allocate(self, arena, size);
    self->tolerated = allocate(self, arena, self->is_fixed ? 0 : size);
    self->pdot1 = allocate(self, arena, nq);
    self->vdot1 = allocate(self, arena, nv);
    self->power1 = allocate(self, arena, 1);
    self->pivots1 = allocate(self, arena, nv);
    self->Phi = allocate(self, arena, self->mh);
    self->dp = allocate(self, arena, nq);
    self->dv = allocate(self, arena, nv);
    self->other = allocate(self, arena, nq + 2 * nv + m + 1);
    self->polynomial = allocate(self, arena, (int64_t)T->coefficients * size);
}

/* Index of the entry of y that the event is, -1 if it is none. */
static int entry_of(const zd_lanes *self, const zd_events *events, int event)
{
    if (!zd_is_known(events, event) || events->known[event].function) return -1;
    const zd_argument *reads = events->known[event].reading;
    return reads->what == ZD_READS_P ? reads->index : reads->what == ZD_READS_V ? self->nq + reads->index : -1;
}

static void create_events(zd_lanes *self, zd_arena *arena, const zd_events *events)
{
    if (!events) return;
    zd_watched *watched = zd_arena_bytes(arena, events->count * sizeof *watched);
    self->watched = watched;
    self->events = events->count;
    self->watches = ZD_WATCHES_NUMBERS;
    for (int i = 0; i < events->count; i++) {
        const int entry = entry_of(self, events, i);
        if (entry < 0 || !self->is_fixed) self->watches = ZD_WATCHES_STEPS;
        else if (watched) watched[i] = (zd_watched){entry, events->known[i].value};
    }
}

void zd_lanes_create(zd_lanes *self, zd_arena *arena, const zd_run *run, const zd_lane_functions *functions,
                     const zd_closed_form *closed_form, int64_t doubles)
{
    const zd_settings *settings = &run->settings;
    const zd_system *system = &run->motion.system;
    const zd_guard *guard = &run->safeguards.guard;
    zd_arena_bytes(arena, 0);       /* no gap before the first array */
    const size_t before = arena->used;
    *self = (zd_lanes){
        .closed_form = closed_form, .method = method_of(run->stepper.integrator), .lanes = functions->lanes,
        .nq = system->nq, .nv = system->nv, .m = zd_constraints(system), .mh = system->mh, .size = run->motion.rate.size,
        .has_A = (system->provides & ZD_A) != 0, .has_input = run->motion.balance.input != NULL,
        .max_iterations = run->motion.target.max_iterations, .corrects = run->motion.corrections > 0,
        .is_fixed = settings->steps == ZD_FIXED_STEPS, .t0 = settings->t0, .end = settings->t1, .step = settings->step,
        .steps = (double)run->loop.steps,
        .rtol = settings->rtol, .atol = settings->atol, .longest = settings->max_step > 0 ? settings->max_step : INFINITY,
        .tiny = 16 * 0x1p-52 * fmax(fabs(settings->t0), fabs(settings->t1)),
        .max_steps = settings->max_steps ? (double)settings->max_steps : INFINITY, .save_every = (double)settings->save_every,
        .decay = run->stepper.integrator->decay,
        .every = run->motion.target.every,
        .astray = guard->astray, .nearby = guard->nearby, .limit = guard->limit,
        .weight = run->safeguards.resolution.weight, .order_of_method = run->stepper.integrator->card.order,
    };
    create_states(self, arena, doubles, system->inputs);
    self->states = (int64_t)((arena->used - before) / sizeof(double)) / self->lanes;
    create_workspace(self, arena);
    self->count = (int64_t)((arena->used - before) / sizeof(double)) / self->lanes;
    create_events(self, arena, settings->events);
}

void zd_lanes_copy(zd_lanes *self, int from, int to)
{
    for (int64_t i = 0; i < self->count; i++) self->first[i * self->lanes + to] = self->first[i * self->lanes + from];
}

static void load(const zd_lanes *self, int lane, int64_t count, const double *from, double *to)
{
    const int64_t stride = self->lanes;
    to += lane;
    for (; count >= 4; count -= 4, from += 4, to += 4 * stride)
        to[0] = from[0], to[stride] = from[1], to[2 * stride] = from[2], to[3 * stride] = from[3];
    for (; count > 0; count--, from++, to += stride) *to = *from;
}

static void load_state(zd_lanes *self, int lane, const zd_run *run)
{
    const zd_point *point = run->motion.point;
    load(self, lane, self->nq, point->p, self->y);
    load(self, lane, self->nv, point->v, self->y + self->nq * self->lanes);
    if (self->has_input) zd_lane_set(self, self->y, self->size - 1, lane, 0);
}

/* Order of elimination and rates are found later, for all lanes at once. */
static void load_closed_form(zd_lanes *self, int lane, zd_run *run)
{
    zd_closed_form_find_scales(&run->motion);
    load(self, lane, (int64_t)self->closed_form->orders * self->nv, run->motion.path.scale, self->scale);
    self->order[lane] = NAN;
}

/* Scales that are constant during a run: of p, v, and of Phi. */
static void load_units(zd_lanes *self, int lane, const zd_run *run)
{
    const zd_point *point = run->motion.point;
    load(self, lane, self->nq, point->inverse_unit_p, self->inverse_unit_p);
    load(self, lane, self->nv, point->inverse_unit, self->inverse_unit);
    load(self, lane, self->mh, point->inverse_size, self->inverse_size);
    for (int k = 0; k < self->mh; k++) zd_lane_set(self, self->allowed, k, lane, run->motion.target.tolerance * point->size[k]);
}

static void clear(const zd_lanes *self, int lane, int64_t count, double *numbers)
{
    const int64_t stride = self->lanes;
    numbers += lane;
    for (; count >= 4; count -= 4, numbers += 4 * stride) numbers[0] = numbers[stride] = numbers[2 * stride] = numbers[3 * stride] = 0;
    for (; count > 0; count--, numbers += stride) *numbers = 0;
}

/* Sets the step of the first full check: see guard.c. */
static void set_first_check(zd_lanes *self, int lane)
{
    self->next_check[lane] = self->is_fixed ? 1 : ZD_CHECK_SELDOM;
    self->check_pause[lane] = self->is_fixed ? ZD_CHECK_EVERY : ZD_CHECK_SELDOM;
}

void zd_lanes_load(zd_lanes *self, int lane, zd_run *run, const double *data, int64_t doubles)
{
    clear(self, lane, self->numbers_from_zero, self->from_zero);
    load(self, lane, doubles, data, self->data);
    if (self->inputs) load(self, lane, 2 * run->motion.system.inputs + 1, run->motion.point->inputs, self->inputs);
    load_state(self, lane, run);
    load_units(self, lane, run);
    load_closed_form(self, lane, run);
    self->is_active[lane] = 1;
    self->t[lane] = self->t_before[lane] = self->t_sample[lane] = self->next_t[lane] = self->t0;
    self->h[lane] = run->loop.control.h;
    set_first_check(self, lane);
}
