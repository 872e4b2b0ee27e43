/* Creation of a phase: its rows, the structure that they have, the loads that its friction reads, and its closed-form functions. */
#include <string.h>

#include "phase_system.h"

static int is_sliding_with_load(const zd_group *group, signed char state)
{
    return group->kind == ZD_FRICTION && zd_slides(state) && (group->normal || group->loads);
}

/* Index of the group for which a row is active; -1: it is of no group; -2: it is not active. */
static int find_group(const zd_phase_system *self, int row)
{
    if (!self->is_switched[row]) return -1;
    for (int g = 0; g < self->full->groups; g++) {
        const zd_group *group = self->full->group + g;
        if (self->state[g] == ZD_CLOSED && row >= group->first && row < group->first + group->rows) return g;
    }
    return -2;
}

static void list_rows(zd_phase_system *self)
{
    const zd_system *full = self->full;
    int m = 0;
    for (int g = 0; g < full->groups; g++)
        for (int i = 0; i < full->group[g].rows; i++) self->is_switched[full->group[g].first + i] = 1;
    for (int row = 0; row < zd_constraints(full); row++) self->row_here[row] = -1;
    for (int holonomic = 1; holonomic >= 0; holonomic--) {
        for (int row = 0; row < zd_constraints(full); row++) {
            const int g = find_group(self, row);
            const int is_rate = g >= 0 && (full->group[g].kind == ZD_FRICTION || full->group[g].kind == ZD_ONE_WAY);
            if (g < -1 || (row < full->mh && !is_rate) != holonomic) continue;
            self->value[m] = g >= 0 ? full->group[g].value : 0;
            self->keeps_value[m] = g >= 0 && full->group[g].kind == ZD_TWO_SIDED;
            self->row_here[row] = m;
            self->row[m++] = row;
        }
        if (holonomic) self->system.mh = m;
    }
    self->system.mn = m - self->system.mh;
}

/* Groups of rows that the structure declares, restricted to active rows; a group is split where holonomic and nonholonomic rows meet. */
static void declare_structure(zd_phase_system *self, int *rows, int *first, int *block)
{
    const zd_structure *inner = self->full->structure;
    const zd_layout *layout = self->layout;
    int groups = 0, before = -1;
    first[0] = 0;
    for (int k = 0; k < zd_constraints(&self->system); k++) {
        const int g = layout->group_of[self->row[k]];
        if (groups && g == before && k != self->system.mh) {
            rows[groups - 1]++;
            continue;
        }
        const int count = inner->first[g + 1] - inner->first[g];
        memcpy(block + first[groups], inner->block + inner->first[g], count * sizeof *block);
        first[groups + 1] = first[groups] + count;
        rows[groups++] = 1;
        before = g;
    }
    self->structure = *inner;
    self->structure.groups = groups;
    self->structure.rows = rows, self->structure.first = first, self->structure.block = block;
    self->system.structure = &self->structure;
}

static void create_structure(zd_arena *arena, zd_phase_system *self)
{
    const zd_system *full = self->full;
    if (!full->structure) return;
    const int m = zd_constraints(full), touched = full->structure->blocks;
    int *rows = zd_arena_ints(arena, m), *first = zd_arena_ints(arena, m + 1), *block = zd_arena_ints(arena, m * touched);
    if (arena->base) declare_structure(self, rows, first, block);
}

/* Functions that read the loads of sliding friction, after those of the full system. */
static void fill_reading(zd_phase_system *self)
{
    const zd_system *full = self->full;
    static const zd_reading none = {0};
    const zd_reading *own = full->reading ? full->reading : &none;
    zd_reading *all = &self->reading;
    *all = *own;
    if (own->count) memcpy(self->reaction, own->reaction, own->count * sizeof *own->reaction);
    if (own->reads) memcpy(self->read, own->read, own->reads * sizeof *own->read);
    if (own->functions) memcpy(self->name, own->name, own->functions * sizeof *own->name);
    for (int g = 0; g < full->groups; g++) {
        const zd_group *group = full->group + g;
        if (group->kind != ZD_FRICTION || !zd_slides(self->state[g])) continue;
        zd_sliding *it = self->sliding + self->slidings++;
        self->has_sliding_pairs |= group->rows == 2;
        *it = (zd_sliding){g, -1, all->count, 0};
        if (!is_sliding_with_load(group, self->state[g])) continue;
        it->input = all->functions;
        self->name[all->functions] = group->name;
        it->reactions = group->normal ? 1 : group->loads;
        for (int i = 0; i < it->reactions; i++) {
            self->reaction[all->count] = (zd_read_reaction){zd_own_measures(full) + zd_first_load(full, group) + i, 0};
            self->read[all->reads++] = (zd_read){all->functions, all->count++};
        }
        all->functions++;
    }
    all->reaction = self->reaction, all->read = self->read, all->name = self->name;
    self->system.reading = all->functions ? all : NULL;
}

static void create_reading(zd_arena *arena, zd_phase_system *self)
{
    const zd_reading *own = self->full->reading;
    const int groups = self->full->groups, functions = own ? own->functions : 0, count = own ? own->count : 0, reads = own ? own->reads : 0;
    self->sliding = zd_arena_bytes(arena, groups * sizeof *self->sliding);
    self->reaction = zd_arena_bytes(arena, (count + groups * ZD_MAX_LOADS) * sizeof *self->reaction);
    self->read = zd_arena_bytes(arena, (reads + groups * ZD_MAX_LOADS) * sizeof *self->read);
    self->name = zd_arena_bytes(arena, (functions + groups) * sizeof *self->name);
    if (arena->base) fill_reading(self);
}

/* ---- closed-form functions ----
 *
 * Closed-form functions of the full system eliminate the constraints outside all groups. A phase in which no group acts has the same
 * constraints, and calls them with the data of the full system. */

static const void *data_of(const void *data) { return ((const zd_phase_system *)data)->full->data; }

static int accelerate(const zd_elimination *self, const void *data, const double *inputs, const double *t, const double *p, const double *v,
                      const double *added, double *pdot, double *vdot, double *lambda, double *power, double *pivots)
{
    const zd_elimination *of = self->program;
    return of->accelerate(of, data_of(data), inputs, t, p, v, added, pdot, vdot, lambda, power, pivots);
}

static int correct(const zd_elimination *self, const void *data, const double *inputs, const double *t, const double *p, const double *v,
                   double *Phi, double *dp, double *dv)
{
    const zd_elimination *of = self->program;
    return of->correct(of, data_of(data), inputs, t, p, v, Phi, dp, dv);
}

static int finish(const zd_elimination *self, const void *data, const double *inputs, const double *t, const double *p, double *v,
                  const double *allowed, double *Phi, double *dp, double *pdot, double *vdot, double *lambda, double *power, double *pivots)
{
    const zd_elimination *of = self->program;
    return of->finish(of, data_of(data), inputs, t, p, v, allowed, Phi, dp, pdot, vdot, lambda, power, pivots);
}

static int embed(const zd_elimination *self, const void *data, const double *inputs, const double *t, const double *p, double *v,
                 const double *added, const double *allowed, double *Phi, double *dp, double *D, double *pdot, double *vdot, double *lambda,
                 double *power, double *pivots)
{
    const zd_elimination *of = self->program;
    return of->embed(of, data_of(data), inputs, t, p, v, added, allowed, Phi, dp, D, pdot, vdot, lambda, power, pivots);
}

static const zd_elimination *create_eliminations(zd_arena *arena, int count, const zd_elimination *of)
{
    zd_elimination *here = zd_arena_bytes(arena, count * sizeof *here);
    for (int i = 0; here && i < count; i++) {
        here[i] = of[i];
        here[i].program = of + i;
        if (of[i].accelerate) here[i].accelerate = accelerate;
        if (of[i].correct) here[i].correct = correct;
        if (of[i].finish) here[i].finish = finish;
        if (of[i].embed) here[i].embed = embed;
    }
    return here;
}

static void create_closed_forms(zd_arena *arena, zd_phase_system *self)
{
    const zd_system *full = self->full;
    self->closed_form = zd_arena_bytes(arena, full->closed_forms * sizeof *self->closed_form);
    for (int i = 0; i < full->closed_forms; i++) {
        zd_closed_form it = full->closed_form[i];
        if (it.lanes != 1) continue;
        it.order = create_eliminations(arena, it.orders, it.order);
        it.embedding = create_eliminations(arena, it.embeddings, it.embedding);
        if (self->closed_form) self->closed_form[self->closed_forms++] = it;
    }
    if (self->slidings || zd_constraints(&self->system) > zd_own_constraints(full)) self->closed_forms = 0;
}

zd_phase_system *zd_phase_system_create(zd_arena *arena, const zd_system *full, const signed char *state)
{
    const int m = zd_constraints(full), groups = full->groups;
    zd_phase_system nowhere, *here = zd_arena_bytes(arena, sizeof *here), *self = here ? here : &nowhere;
    *self = (zd_phase_system){.system = *full, .full = full, .size_of_C = zd_size_of_C(full)};
    self->state = zd_arena_bytes(arena, groups);
    self->row = zd_arena_ints(arena, m);
    self->row_here = zd_arena_ints(arena, m);
    self->is_switched = zd_arena_ints(arena, m);
    self->value = zd_arena_doubles(arena, m);
    self->keeps_value = zd_arena_ints(arena, m);
    self->part = zd_arena_ints(arena, groups);
    self->tie = zd_arena_ints(arena, groups);
    self->tie_factor = zd_arena_doubles(arena, groups);
    self->bias = zd_arena_doubles(arena, groups);
    self->lambda = zd_arena_doubles(arena, m);
    self->direction = zd_arena_doubles(arena, 2 * (size_t)groups);
    self->slip_speed = zd_arena_doubles(arena, groups);
    self->mobility = zd_arena_doubles(arena, groups);
    self->turning_slip = zd_arena_doubles(arena, groups);
    self->slow_steps = zd_arena_ints(arena, groups);
    self->slow_slip = ZD_SLOW_SLIP * (full->length > 0 ? full->length : 1);
    zd_known_terms known = {.p = zd_arena_doubles(arena, full->nq), .v = zd_arena_doubles(arena, full->nv),
                            .row = zd_arena_doubles(arena, full->nv)};
    if (zd_has_pairs(full)) known.part = zd_arena_bytes(arena, groups * sizeof *known.part);
    self->known = zd_arena_copy(arena, &known, sizeof known);
    self->scratch = zd_arena_doubles(arena, full->scratch + self->size_of_C + full->mh + 2 * (size_t)m);
    self->layout = zd_layout_create(arena, full);
    if (arena->base) {
        memcpy(self->state, state, groups);
        list_rows(self);
    }
    create_structure(arena, self);
    create_reading(arena, self);
    create_closed_forms(arena, self);
    self->measure = zd_arena_bytes(arena, (zd_own_measures(full) + m) * sizeof *self->measure);
    if (arena->base) zd_phase_pass_functions(self);
    return here;
}

typedef struct phase_making {
    const zd_system *full;
    const signed char *state;
} phase_making;

static void *make(zd_arena *arena, const void *of)
{
    const phase_making *it = of;
    return zd_phase_system_create(arena, it->full, it->state);
}

zd_system *zd_phase_new(const zd_system *system, const signed char *state)
{
    zd_store store = {NULL};
    zd_phase_system *self = zd_store_create(&store, make, &(phase_making){system, state});
    if (self) self->memory = store.last;
    return self ? &self->system : NULL;
}

void zd_phase_free(zd_system *phase)
{
    if (phase) zd_memory_free(((const zd_phase_system *)phase->data)->memory);
}

const int *zd_phase_rows(const zd_system *phase) { return ((const zd_phase_system *)phase->data)->row; }
