/* Restoring of a saved state: saved_state.c. */
#include <stdio.h>

#include "../paths/path.h"
#include "saved_state.h"

typedef struct source {     /* words that are read; 0 beyond the end */
    const unsigned char *from;
    size_t count, next;
} source;

static uint64_t get(source *self) { return self->next < self->count ? word_at(self->from, self->next++) : (self->next++, 0); }

/* The run that is restored, with its blocks, whose lists are written to. */
typedef struct target {
    zd_run *run;
    zd_system system;
    zd_memory **block;
    int blocks;
} target;

/* The word that an entry of one address stands for. */
static uint64_t decoded(const target *to, enum kind kind, uint64_t first, uint64_t offset)
{
    if (kind == IN_RUN) return first < (uint64_t)to->blocks ? (uint64_t)((uintptr_t)to->block[first] + offset) : 0;
    return first < sizeof to->system / WORD ? word_at(&to->system, first) : 0;
}

/* Applies the entries of a block to its image; 0: they do not fit it. */
static int apply(const target *to, zd_memory *block, source *from)
{
    const size_t left_out = zd_state_left_out(to->run, block) * WORD;
    if (block->image) memcpy(block->base + left_out, block->image + left_out, block->bytes - left_out);
    for (uint64_t head = get(from); head != ZD_STATE_END; head = get(from)) {
        const enum kind kind = (enum kind)(head % 8);
        const uint64_t i = head / 8, first = get(from), count = kind == NUMBERS ? first : 1, words = words_of(block);
        if (from->next > from->count || i >= words || count > words - i) return 0;
        for (uint64_t k = 0; k < count; k++) {
            const uint64_t word = kind == NUMBERS ? get(from) : decoded(to, kind, first, kind == IN_RUN ? get(from) : 0);
            memcpy(block->base + (i + k) * WORD, &word, sizeof word);
        }
    }
    return 1;
}

#define OF_UNIT(name) "a saved state must be restored with the vector unit that it was saved with, which is " name
static const char *const UNITS[] = {OF_UNIT("none"), OF_UNIT("baseline"), OF_UNIT("avx2"), OF_UNIT("avx512")};

static const char *wrong_header(const uint64_t *header, const unsigned char *block, size_t bytes, const zd_system *system,
                                const zd_settings *settings, const char *fingerprint)
{
    uint64_t expected[ZD_STATE_FINGERPRINT_WORDS] = {0};
    zd_state_write_fingerprint(fingerprint, expected);
    if (bytes < HEADER * WORD || header[0] != ZD_STATE_MAGIC) return "a saved state must have been saved by this version";
    if (header[ALL_BYTES] != bytes) return "a saved state must be whole: bytes are missing or added";
    if (zd_state_hash(0, block + HEADER * WORD, bytes - HEADER * WORD) != header[CHECKSUM])
        return "a saved state must be unchanged: it is damaged";
    if (memcmp(expected, header + FINGERPRINT, sizeof expected) || header[COORDINATES] != (uint64_t)system->nq
        || header[VELOCITIES] != (uint64_t)system->nv || header[PLACES] != zd_inputs_numbers(settings->inputs))
        return "a saved state must be of the same system, with the same parameters, and of a version of zerodrift with the same layout";
    if (header[UNIT] != (uint64_t)(zd_closed_form_unit(system, settings) + 1))
        return UNITS[header[UNIT] % (sizeof UNITS / sizeof *UNITS)];
    return NULL;
}

static void get_all(source *self, double *numbers, size_t count)
{
    for (size_t k = 0; k < count; k++) {
        const uint64_t word = get(self);
        memcpy(numbers + k, &word, sizeof word);
    }
}

/* Finds the phases and opens their plans as the saved run did. */
static int get_phases(zd_run *run, source *from)
{
    zd_phases *phases = run->phases;
    const int groups = phases ? phases->full->groups : 0;
    int status = ZD_DONE;
    signed char *state = zd_allocate((size_t)groups);
    if (!state) return ZD_NO_MEMORY;
    for (uint64_t left = get(from); left && !status; left--) {
        for (int g = 0; g < groups; g++) state[g] = (signed char)get(from);
        zd_phase *phase = phases && from->next < from->count ? zd_phases_find(phases, state) : NULL;
        if (!phase) status = phases && from->next < from->count ? ZD_NO_MEMORY : ZD_BAD_ARGUMENT;
        if (status || !get(from)) continue;
        get_all(from, phase->opened, zd_state_opening(phases));
        if (!phase->is_open) status = zd_phase_reopen(run, phase);
    }
    zd_release(state);
    return status;
}

/* Adds the blocks of a plan that were allocated on demand, the oldest first. */
static int get_plan(zd_run *plan, source *from)
{
    const uint64_t blocks = get(from);
    uint64_t own = 0;
    for (const zd_memory *block = plan->motion.store.last; block; block = block->previous) own++;
    if (blocks < own || blocks > from->count) return ZD_BAD_ARGUMENT;
    source size = *from;
    from->next += blocks;
    for (uint64_t k = blocks - own; k > 0; k--) {
        size.next = from->next - blocks + k - 1;
        if (!zd_store_add(&plan->motion.store, get(&size))) return ZD_NO_MEMORY;
    }
    return ZD_DONE;
}

/* Applies all entries; the blocks of a target are those of its run. */
static int apply_all(const target *to, source *from)
{
    int i = 0, fit = 1;
    for (zd_run_memory it = zd_run_memory_first(to->run); it.block; zd_run_memory_next(&it)) to->block[i++] = it.block;
    for (i = 0; i < to->blocks && fit; i++) fit = apply(to, to->block[i], from);
    return fit ? ZD_DONE : ZD_BAD_ARGUMENT;
}

/* Adds phases and blocks, and applies all entries. */
static int fill(zd_run *run, source *from)
{
    const zd_inputs *inputs = run->settings.inputs;
    const size_t count = zd_inputs_numbers(inputs);
    double *numbers = zd_allocate(count * sizeof *numbers);
    if (numbers) get_all(from, numbers, count);
    int status = numbers ? get_phases(run, from) : ZD_NO_MEMORY;
    if (numbers) zd_inputs_restore(inputs, numbers);
    zd_release(numbers);
    target to = {.run = run};
    const zd_run *plan = NULL;
    for (zd_run_memory it = zd_run_memory_first(run); it.block && !status; zd_run_memory_next(&it)) {
        if (it.plan != plan) status = get_plan(it.plan, from);
        plan = it.plan;
        if (run->phases && it.phase == run->phases->present) run->motion.store = plan->motion.store;
    }
    for (zd_run_memory it = zd_run_memory_first(run); it.block; zd_run_memory_next(&it)) to.blocks++;
    to.system = *zd_state_system(run);
    to.block = status ? NULL : zd_allocate((size_t)to.blocks * sizeof *to.block);
    if (!status) status = to.block ? apply_all(&to, from) : ZD_NO_MEMORY;
    zd_release(to.block);
    return status;
}

static void bind_plan(zd_run *plan, source *from)
{
    if (get(from)) plan->motion.formulation = plan->stepper.dependent.formulation;
    zd_path_bind(&plan->motion);
}

/* Functions of plans, which follow from their elimination orders; and the plan of the present phase in its place. */
static void bind(zd_run *run, source *from)
{
    zd_memory *start = run->start;
    if (!run->phases) bind_plan(run, from);
    const zd_phase *phase = NULL;
    while ((phase = zd_next_open_phase(run, phase))) {
        phase->plan->start = start;
        bind_plan(phase->plan, from);
    }
    if (run->phases) *run = *run->phases->present->plan;
}

zd_run *zd_state_restore(const zd_system *system, const zd_settings *settings, const void *block, size_t bytes, const char *fingerprint,
                         int *status, char *message, int message_size)
{
    uint64_t header[HEADER] = {0};
    memcpy(header, block, bytes < sizeof header ? bytes : sizeof header);
    const char *wrong = wrong_header(header, block, bytes, system, settings, fingerprint);
    source from = {block, bytes / WORD, HEADER + (size_t)(system->nq + system->nv)};
    zd_memory *start = wrong ? NULL : zd_memory_create((system->nq + system->nv) * sizeof(double));
    zd_run *run = NULL;
    if (start) {
        double *p0 = (void *)start->base;
        memcpy(p0, (const unsigned char *)block + HEADER * WORD, (system->nq + system->nv) * sizeof *p0);
        run = zd_run_create(system, settings, p0, p0 + system->nq, status, message, message_size);
        if (run) *status = zd_state_begin(run, p0, p0 + system->nq);
        const int agree = run && header[SETTINGS] == zd_state_hash_settings(&run->settings);
        if (agree && !*status) *status = fill(run, &from);
        if (agree && !*status) bind(run, &from);
        zd_memory_free(start);
        if (!run || (agree && !*status)) return run;
        wrong = !agree ? "a saved state must be of a run with the same settings"
              : *status == ZD_NO_MEMORY ? NULL : "a saved state must fit the memory of its run";
    }
    zd_run_free(run);
    *status = wrong ? ZD_BAD_ARGUMENT : ZD_NO_MEMORY;
    snprintf(message, message_size, "%s", wrong ? wrong : "there is no memory for a saved state");
    return NULL;
}
