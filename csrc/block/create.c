/* From a block to a mechanism: its tables are those that Python would give to the core. */
#include "made.h"

#include <string.h>

#include "../methods.h"
#include "../workspace.h"

#define DECLARE(name) extern const zd_block_dimension name;
#define ADDRESS(name) &name,

ZD_DIMENSION_LIST(DECLARE)

static const zd_block_dimension *const dimensions[] = {ZD_DIMENSION_LIST(ADDRESS) NULL};

/* Arrays of the tables, needed until the mechanism has its own. */
typedef struct arrays {
    void *section[ZD_BLOCK_GROUPS + 1];
} arrays;

static arrays create_tables(const zd_block_layout *layout, zd_arena *arena)
{
    arrays taken = {{NULL}};
    for (int section = ZD_BLOCK_BODIES; section <= ZD_BLOCK_GROUPS; section++) {
        const size_t size = zd_block_structure_in(layout, section)->size;
        taken.section[section] = zd_arena_bytes(arena, (size_t)zd_block_count(layout, section) * size);
    }
    return taken;
}

/* ---- checks of what the mechanism does not check ---- */

static int laws_suit(const zd_block *self, const zd_elements *elements, zd_complaint to)
{
    for (int i = 0; i < elements->relations; i++) {
        const zd_relation *row = elements->relation + i;
        if (row->law >= 0 && !zd_block_law_suits(&self->laws, &self->layout, row->law, row->terms, row->terms + 3))
            return zd_complain(to, "relation %d: its law must exist, with its marker quantities and results", i);
    }
    for (int i = 0; i < elements->forces; i++) {
        const zd_generalized_force *force = elements->force + i;
        if (force->law >= 0 && !zd_block_law_suits(&self->laws, &self->layout, force->law, force->terms, 1))
            return zd_complain(to, "force %d: its law must exist, with its marker quantities and one result", i);
    }
    for (int i = 0; i < elements->measures; i++) {
        const zd_output_spec *formula = elements->measure + i;
        if (formula->kind == ZD_FORMULA && !zd_block_law_suits(&self->laws, &self->layout, formula->index, formula->size, 1))
            return zd_complain(to, "measure %d must have a law that exists, with its inputs and one result", i);
    }
    return 1;
}

/* A zd_law, which is called only where the values of a program are not finite. */
static int fail(void *owner, int law, double t, const double *x, const double *xdot, double *out)
{
    (void)owner, (void)law, (void)t, (void)x, (void)xdot, (void)out;
    return ZD_CALLBACK;
}

static int fits(zd_block *self, zd_complaint to)
{
    const int start = zd_block_count(&self->layout, ZD_BLOCK_START), needed = self->system.nq + self->system.nv;
    if (start && start != needed) return zd_complain(to, "the start must have %d numbers, p and v, not %d", needed, start);
    for (int i = 0; i < zd_block_count(&self->layout, ZD_BLOCK_OUTPUTS); i++) {
        const double measure = *zd_block_entry(&self->layout, ZD_BLOCK_OUTPUTS, i);
        if (!zd_block_is_integer(measure, 0, zd_block_count(&self->layout, ZD_BLOCK_MEASURES)))
            return zd_complain(to, "output %d: its measure must exist, and is %g", i, measure);
        self->output[i] = (int)measure;
    }
    return zd_block_inputs_check(self, to) && zd_block_parameters_check(&self->layout, to) && zd_block_events_unpack(self, to);
}

/* ---- the mechanism ---- */

static zd_elements elements_of(zd_block *self, const arrays *from)
{
    const zd_block_layout *layout = &self->layout;
    const int laws = zd_block_count(layout, ZD_BLOCK_LAWS);
    return (zd_elements){
        .terms = zd_block_count(layout, ZD_BLOCK_TERMS), .relations = zd_block_count(layout, ZD_BLOCK_RELATIONS),
        .forces = zd_block_count(layout, ZD_BLOCK_FORCES), .measures = zd_block_count(layout, ZD_BLOCK_MEASURES),
        .term = from->section[ZD_BLOCK_TERMS], .relation = from->section[ZD_BLOCK_RELATIONS],
        .force = from->section[ZD_BLOCK_FORCES], .measure = from->section[ZD_BLOCK_MEASURES],
        .groups = zd_block_count(layout, ZD_BLOCK_GROUPS), .group = from->section[ZD_BLOCK_GROUPS],
        .law = laws ? fail : NULL, .program = self->laws.program, .laws_know_time = self->laws.know_time,
        .length = layout->part[ZD_BLOCK_GRAVITY].word[layout->of->dimension]};
}

static int make(zd_block *self, const arrays *from, zd_complaint to)
{
    const zd_elements elements = elements_of(self, from);
    for (int section = ZD_BLOCK_BODIES; section <= ZD_BLOCK_GROUPS; section++)
        if (!zd_block_unpack(&self->layout, section, from->section[section], to)) return 0;
    if (!laws_suit(self, &elements, to) || !zd_block_names_check(&self->layout, to)) return 0;
    if (!self->layout.of->make(self, from->section, &elements, to)) return 0;
    self->system.name_constraint = zd_block_name_row;
    self->system.names = &self->names;
    if (!self->laws.have_ends) self->system.check_domain = NULL;
    if (zd_block_count(&self->layout, ZD_BLOCK_LAWS))
        self->system.failure = "a user function of the mechanism must be defined at this state: a table, for example, within its ends";
    self->outputs = (zd_outputs){NULL, zd_block_count(&self->layout, ZD_BLOCK_OUTPUTS), self->output};
    if (!fits(self, to)) return 0;
    zd_block_inputs_begin(self);
    return 1;
}

/* ---- memory ---- */

static zd_block *create(zd_arena *arena, size_t size, const zd_block_layout *layout)
{
    zd_block nowhere = {.size = 0}, *here = zd_arena_bytes(arena, sizeof *here), *self = here ? here : &nowhere;
    self->word = zd_arena_bytes(arena, size);
    zd_block_laws_create(&self->laws, layout, arena);
    const size_t inputs = zd_block_count(layout, ZD_BLOCK_INPUTS);
    zd_block_inputs_memory *memory = &self->inputs_memory;
    memory->value = zd_arena_doubles(arena, inputs);
    memory->lower = zd_arena_doubles(arena, inputs);
    memory->upper = zd_arena_doubles(arena, inputs);
    memory->place = zd_arena_bytes(arena, inputs * sizeof *memory->place);
    zd_block_events_create(&self->events, layout, arena);
    self->output = zd_arena_bytes(arena, zd_block_count(layout, ZD_BLOCK_OUTPUTS) * sizeof *self->output);
    return here;
}

static zd_block *copy_of(const double *word, size_t size, zd_complaint to)
{
    zd_block_layout layout;
    if (!zd_block_split(word, size / sizeof *word, dimensions, &layout, to)) return NULL;
    zd_arena counting = {0};
    create(&counting, size, &layout);
    zd_arena arena = {.base = zd_allocate(counting.used)};
    if (!arena.base) {
        zd_complain(to, "there is no memory for the mechanism");
        return NULL;
    }
    zd_block *self = create(&arena, size, &layout);
    memcpy(self->word, word, size);
    self->size = size;
    zd_block_split(self->word, size / sizeof *word, dimensions, &self->layout, to);
    self->names.layout = &self->layout;
    if (zd_block_laws_unpack(&self->laws, &self->layout, to)) return self;
    zd_release(self);
    return NULL;
}

zd_block *zd_block_create(const void *data, size_t size, char *message, int message_size)
{
    const zd_complaint to = {message, message_size};
    if (size % sizeof(double)) {
        zd_complain(to, "the block must be words of 8 bytes, not %g bytes", (double)size);
        return NULL;
    }
    double *aligned = zd_allocate(size);
    if (aligned) memcpy(aligned, data, size);
    else zd_complain(to, "there is no memory for the mechanism");
    zd_block *self = aligned ? copy_of(aligned, size, to) : NULL;
    zd_release(aligned);
    if (!self) return NULL;
    zd_arena counting = {0};
    create_tables(&self->layout, &counting);
    zd_arena arena = {.base = zd_allocate(counting.used)};
    const arrays all = create_tables(&self->layout, &arena);
    const int is_made = arena.base ? make(self, &all, to) : zd_complain(to, "there is no memory for the mechanism");
    zd_release(arena.base);
    if (is_made) return self;
    zd_block_free(self);
    return NULL;
}

void zd_block_free(zd_block *block)
{
    if (block && block->mechanism) block->layout.of->release(block->mechanism);
    zd_release(block);
}

const zd_system *zd_block_system(const zd_block *block) { return &block->system; }

int zd_block_bodies(const zd_block *block) { return zd_block_count(&block->layout, ZD_BLOCK_BODIES); }

int zd_block_poses(const zd_block *block, const double *p, double *poses, double *scratch)
{
    const zd_block_dimension *of = block->layout.of;
    if (poses) of->poses(block->mechanism, p, poses, scratch);
    return of->pose;
}

const double *zd_block_start(const zd_block *block)
{
    const zd_block_part *start = block->layout.part + ZD_BLOCK_START;
    return start->count ? start->word : NULL;
}

const double *zd_block_words(const zd_block *block, size_t *size)
{
    *size = block->size;
    return block->word;
}
