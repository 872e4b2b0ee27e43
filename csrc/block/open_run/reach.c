/* Explanation of drives that an open run of a block cannot follow: at a dead point, or with changed lengths. */
#include <math.h>
#include <string.h>

#include "../../mechanisms/common/assembly/given.h"
#include "../../workspace.h"
#include "../made.h"
#include "opened_memory.h"

static const double STEPS_AHEAD = 4;    /* number of fixed steps in which a dead point may be the cause of a failure */
static const double AHEAD = 1e-3;       /* s: the same with adaptive steps */
static const double MET = 1e-9;         /* relative to its size: residual of a drive that is met */
enum { NAME = 64 };
/* Numbers of a relation and of a measure in a block, in the order of structures.c. */
enum { FIRST_TERM, TERMS, NONHOLONOMIC, LAW, CONSTANT, SLOPE, KIND = 2, QUANTITY, SIZE };

/* Index of the measure of the coordinate that a relation drives; -1: the block has none. */
static int measure_of_drive(const zd_block_layout *layout, int relation)
{
    const double *row = zd_block_entry(layout, ZD_BLOCK_RELATIONS, relation);
    const size_t size = layout->part[ZD_BLOCK_QUANTITIES].width * sizeof *row;
    const double *quantity = zd_block_entry(layout, ZD_BLOCK_QUANTITIES, (int)*zd_block_entry(layout, ZD_BLOCK_TERMS, (int)row[FIRST_TERM]));
    int i = row[TERMS] == 1 ? zd_block_count(layout, ZD_BLOCK_MEASURES) : 0;
    while (i--) {
        const double *measure = zd_block_entry(layout, ZD_BLOCK_MEASURES, i);
        if (zd_block_is(measure[KIND], ZD_VALUES) && zd_block_is(measure[SIZE], 1)
            && !memcmp(quantity, zd_block_entry(layout, ZD_BLOCK_QUANTITIES, (int)measure[QUANTITY]), size)) break;
    }
    return i;
}

/* Copy of the mechanism in which drives of speeds prescribe positions: the present ones plus the present speed times the time since. NULL:
 * without memory, or if the core refuses it. */
static zd_block *with_positions(struct zd_opened *self, double t)
{
    zd_block *block = self->block;
    const zd_system *system = &block->system;
    double *copy = zd_allocate(block->size);
    if (!copy) return NULL;
    memcpy(copy, block->word, block->size);
    for (int i = 0; i < zd_block_count(&block->layout, ZD_BLOCK_RELATIONS); i++) {
        double *row = copy + (zd_block_entry(&block->layout, ZD_BLOCK_RELATIONS, i) - block->word), x, out[4];
        const zd_measured value = {.value = &x};
        const int measure = measure_of_drive(&block->layout, i);
        if (measure < 0 || row[NONHOLONOMIC] == 0) continue;
        system->measures->evaluate(system->data, NULL, measure, t, zd_run_p(self->run), self->v, NULL, NULL, &value, self->scratch);
        zd_expressions_evaluate(block->laws.law + (int)row[LAW], block->laws.program[(int)row[LAW]].numbers, t, &x, self->v, out);
        if (!isfinite(out[2])) continue;
        row[NONHOLONOMIC] = 0, row[LAW] = -1, row[CONSTANT] = x + out[2] * t, row[SLOPE] = -out[2];
    }
    zd_block *made = zd_block_create(copy, block->size, NULL, 0);
    zd_release(copy);
    return made;
}

void zd_opened_explain_reach(struct zd_opened *self)
{
    const double t = zd_run_time(self->run), step = self->settings.step;
    zd_block *block = with_positions(self, t);
    const int mh = block ? block->system.mh : 0;
    int *measure = zd_allocate(mh * sizeof *measure);
    if (block && measure) {
        const zd_block_layout *layout = &block->layout;
        for (int i = 0; i < mh; i++) {
            const zd_constraint_owner *owner = block->names.owner + i;
            measure[i] = owner->owner == ZD_OF_RELATION ? measure_of_drive(layout, owner->index) : -1;
        }
        const zd_assembly_problem given = {.system = &block->system, .t = t, .length = zd_block_length(block)};
        zd_assembly_explain_reach(&given, zd_run_p(self->run), measure, step > 0 ? STEPS_AHEAD * step : AHEAD, self->message,
                                  ZD_OPENED_MESSAGE);
    }
    zd_release(measure);
    if (block) zd_block_free(block);
}

/* Message with the drives and couplings that are not satisfied, by the residuals of all constraints (mh,) relative to their sizes. */
static void name_missed(struct zd_opened *self, const double *residual, const double *size)
{
    zd_complaint to = {self->message, ZD_OPENED_MESSAGE};
    const char *before = "drives and couplings must be possible with these values: the nearest positions miss ";
    char name[NAME];
    for (int k = 0; k < self->block->system.mh; k++) {
        if (self->block->names.owner[k].owner != ZD_OF_RELATION || !(fabs(residual[k]) > MET)) continue;
        zd_block_name_row(&self->block->names, k, name, NAME);
        zd_append(&to, "%s'%s' by %.3g", before, name, fabs(residual[k]) * size[k]);
        before = ", ";
    }
}

/* Role of a row: drives and joints; those that are not active at the start are ignored. */
static int role_of(const zd_block *block, int row)
{
    for (const zd_group *group = block->system.group; group < block->system.group + block->system.groups; group++)
        if (row >= group->first && row < group->first + group->rows && !(group->kind == ZD_TWO_SIDED && group->is_active))
            return ZD_ROLE_IGNORED;
    return block->names.owner[row].owner == ZD_OF_RELATION ? ZD_ROLE_DRIVE : ZD_ROLE_JOINT;
}

int zd_opened_find_positions(struct zd_opened *self, double t, const double *p)
{
    const zd_block *block = self->block;
    const size_t m = block->system.mh + block->system.mn;
    double *residual = zd_allocate(3 * m * sizeof *residual), *size = residual + m;
    if (!residual) return ZD_NO_MEMORY;
    int *role = (int *)(size + m);
    for (int k = 0; k < block->system.mh; k++) role[k] = role_of(block, k);
    const zd_assembly_problem given = {.system = &block->system, .t = t, .length = zd_block_length(block), .role = role, .residual = residual,
                                     .size = size};
    memcpy(self->p, p, block->system.nq * sizeof *p);
    const int outcome = zd_assemble_positions(&given, self->p);
    if (outcome == ZD_TARGETS_UNMET) name_missed(self, residual, size);
    zd_release(residual);
    return outcome ? ZD_BAD_ARGUMENT : ZD_DONE;
}
