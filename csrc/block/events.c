/* Events: quantities of the motion that reach a value, and inputs that are set there. */
#include "../output/reading.h"
#include "made.h"

void zd_block_events_create(zd_block_events *self, const zd_block_layout *layout, zd_arena *arena)
{
    const size_t count = zd_block_count(layout, ZD_BLOCK_EVENTS);
    self->reading = zd_arena_bytes(arena, count * sizeof *self->reading);
    self->known = zd_arena_bytes(arena, count * sizeof *self->known);
    self->direction = zd_arena_ints(arena, count);
    self->terminal = zd_arena_ints(arena, count);
    self->action = zd_arena_bytes(arena, (size_t)zd_block_count(layout, ZD_BLOCK_ACTIONS) * sizeof *self->action);
}

static int is_right(const double *word)
{
    int is = zd_block_is_integer(word[0], ZD_READS_P, ZD_READS_NUMBER);
    for (int i = 1; i < 6; i++) is &= i == 3 || zd_block_is_integer(word[i], -1, 0x1p24);
    return is;
}

int zd_block_events_unpack(zd_block *block, zd_complaint to)
{
    zd_block_events *self = &block->events;
    const int count = zd_block_count(&block->layout, ZD_BLOCK_EVENTS), actions = zd_block_count(&block->layout, ZD_BLOCK_ACTIONS);
    for (int i = 0; i < count; i++) {
        const double *word = zd_block_entry(&block->layout, ZD_BLOCK_EVENTS, i);
        if (!is_right(word)) return zd_complain(to, "event %d: its quantity, direction and occurrence must be whole numbers in range", i);
        self->reading[i] = (zd_argument){.what = (enum zd_source)(int)word[0], .index = (int)word[1], .component = (int)word[2]};
        self->known[i] = (zd_event){.readings = 1, .reading = self->reading + i, .value = word[3]};
        self->direction[i] = (int)word[4];
        self->terminal[i] = (int)word[5];
    }
    for (int i = 0; i < actions; i++) {
        const double *word = zd_block_entry(&block->layout, ZD_BLOCK_ACTIONS, i);
        const int least = ZD_SWITCHES - zd_block_count(&block->layout, ZD_BLOCK_GROUPS) + 1;
        if (!zd_block_is_integer(word[0], 0, count) || !zd_block_is_integer(word[1], least, zd_block_inputs(block)))
            return zd_complain(to, "action %d: its event and its input or group must exist", i);
        self->action[i] = (zd_action){(int)word[0], (int)word[1], word[2]};
    }
    self->all = (zd_events){.count = count, .direction = self->direction, .terminal = self->terminal, .known = self->known,
                            .actions = actions, .action = self->action};
    const char *wrong = zd_wrong_readings(&self->all, &block->system);
    return !wrong || zd_complain(to, "%s", wrong);
}

const zd_events *zd_block_events_of(const zd_block *block) { return block->events.all.count ? &block->events.all : NULL; }
