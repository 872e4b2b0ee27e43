/* Drives that bring the open run of a block to a dead point. */
#include <string.h>

#include "../../mechanisms/common/assembly/given.h"
#include "../../workspace.h"
#include "../made.h"
#include "opened_memory.h"

static const double STEPS_AHEAD = 4;    /* number of fixed steps in which a dead point may be the cause of a failure */
static const double AHEAD = 1e-3;       /* s: the same with adaptive steps */

/* Measure of the coordinate that a relation drives; -1: the block has none. */
static int driven(const zd_block_layout *layout, int relation)
{
    const double *row = zd_block_entry(layout, ZD_BLOCK_RELATIONS, relation);
    const size_t size = (size_t)layout->part[ZD_BLOCK_QUANTITIES].width * sizeof *row;
    const double *quantity = zd_block_entry(layout, ZD_BLOCK_QUANTITIES, (int)*zd_block_entry(layout, ZD_BLOCK_TERMS, (int)row[0]));
    int i = row[1] == 1 ? zd_block_count(layout, ZD_BLOCK_MEASURES) : 0;
    while (i--) {
        const double *measure = zd_block_entry(layout, ZD_BLOCK_MEASURES, i);
        if (zd_block_is(measure[2], ZD_VALUES) && zd_block_is(measure[4], 1)
            && !memcmp(quantity, zd_block_entry(layout, ZD_BLOCK_QUANTITIES, (int)measure[3]), size)) break;
    }
    return i;
}

/* The mechanism whose drives of speeds prescribe positions, at the present speeds from the present positions on; NULL: it is not made. */
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
        const int measure = driven(&block->layout, i);
        if (measure < 0 || row[2] == 0) continue;
        system->measures->evaluate(system->data, NULL, measure, t, zd_run_p(self->run), self->v, NULL, NULL, &value, self->scratch);
        if (zd_block_law(&block->laws, (int)row[3], t, &x, self->v, out)) continue;
        row[2] = 0, row[3] = -1, row[4] = x + out[2] * t, row[5] = -out[2];
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
    int *measure = zd_allocate((size_t)mh * sizeof *measure);
    if (block && measure) {
        const zd_block_layout *layout = &block->layout;
        for (int i = 0; i < mh; i++) {
            const zd_row_owner *owner = block->names.owner + i;
            measure[i] = owner->owner == ZD_OF_RELATION ? driven(layout, owner->index) : -1;
        }
        const double length = layout->part[ZD_BLOCK_GRAVITY].word[layout->of->dimension];
        const zd_assembly_given given = {.system = &block->system, .t = t, .length = length};
        zd_assembly_explain_reach(&given, zd_run_p(self->run), measure, step > 0 ? STEPS_AHEAD * step : AHEAD, self->message,
                                  ZD_OPENED_MESSAGE);
    }
    zd_release(measure);
    if (block) zd_block_free(block);
}
