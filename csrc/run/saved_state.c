/* The state of a run as one flat block without addresses, from which it continues with the same bits, in this process or another.
 *
 * A run that is created from the same system, settings and start has the same memory, except for addresses. So a state is the difference of
 * a run's memory from its image after its creation, word by word; it is restored by applying this difference to a new run. Rooms need not
 * list what they store, and nothing that the next bit depends on can be forgotten: factors, elimination orders, rank decisions, step
 * control, samples that wait for room.
 *
 * Nearly all words that differ are numbers. Functions and tables of the core follow from indices, so that a core of another compiler or
 * with other flags continues the run. Addresses of arrays, as those that were exchanged, are written relative to the run's memory. In memory
 * of numbers none is looked for; elsewhere the bits of an address are those of no double above 1e-307 and of no count below 2^32, and those
 * of two neighbouring ints only if both together agree with an address in the run.
 */
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "saved_state.h"

/* Words of zd_run that follow from the elimination order and from the formulation, as zd_path_bind() sets them. */
#define OF(member) offsetof(zd_run, motion.member)
static const size_t FOLLOWING[] = {OF(formulation), OF(equations), OF(rate.evaluate), OF(rate.closed_form), OF(rate.vdot), OF(rate.expand),
                                   OF(rate.reduce)};

static int follows(size_t i)
{
    int does = 0;
    for (size_t k = 0; k < sizeof FOLLOWING / sizeof *FOLLOWING; k++) does |= i == FOLLOWING[k] / WORD;
    return does;
}

int zd_state_begin(zd_run *run, const double *p0, const double *v0)
{
    const size_t nq = run->motion.system.nq, nv = run->motion.system.nv;
    run->start = zd_memory_create((nq + nv) * sizeof *p0);
    if (!run->start) return ZD_NO_MEMORY;
    memcpy(run->start->base, p0, nq * sizeof *p0);
    memcpy(run->start->base + nq * sizeof *p0, v0, nv * sizeof *v0);
    return zd_run_save_images(run);
}

/* ---- agreement of a state and a run ---- */

uint64_t zd_state_hash(uint64_t so_far, const void *data, size_t bytes)      /* FNV-1a */
{
    for (size_t i = 0; i < bytes; i++) so_far = (so_far ^ ((const unsigned char *)data)[i]) * UINT64_C(0x100000001b3);
    return so_far;
}

static uint64_t hash_given(uint64_t so_far, const zd_parameter_values *given)
{
    so_far = zd_state_hash(so_far, &given->given, sizeof given->given);
    return given->given ? zd_state_hash(so_far, given->value, sizeof given->value) : so_far;
}

uint64_t zd_state_hash_settings(const zd_settings *settings)
{
    const double numbers[] = {
        settings->formulation, settings->integrator, settings->t0, settings->t1, settings->steps, settings->step, settings->rtol,
        settings->atol, settings->first_step, settings->max_step, settings->max_move, (double)settings->max_steps,
        (double)settings->save_every, (double)settings->t_evals, settings->on_singular, settings->closed_form, settings->given_jacobian,
        settings->is_open, settings->events ? settings->events->count : -1, settings->outputs ? settings->outputs->count : -1,
        settings->inputs ? settings->inputs->jumps : 0, settings->inputs ? settings->inputs->ramp : 0,
    };
    uint64_t found = zd_state_hash(UINT64_C(0xcbf29ce484222325), numbers, sizeof numbers);
    found = hash_given(hash_given(found, &settings->of_formulation), &settings->of_integrator);
    for (int i = 0; i < ZD_CORRECTIONS_MAX; i++) found = hash_given(found, &settings->correction[i]);
    return settings->t_eval ? zd_state_hash(found, settings->t_eval, settings->t_evals * sizeof *settings->t_eval) : found;
}

void zd_state_write_fingerprint(const char *fingerprint, uint64_t words[ZD_STATE_FINGERPRINT_WORDS])
{
    snprintf((char *)words, ZD_STATE_FINGERPRINT_WORDS * WORD, "%s", fingerprint);
}

/* ---- saving ---- */

typedef struct sink {       /* words that are written, or only counted */
    unsigned char *to;      /* NULL: counted */
    size_t count;
} sink;

static void set(sink *self, size_t i, uint64_t word)
{
    if (self->to) memcpy(self->to + i * WORD, &word, sizeof word);
}

static void put(sink *self, uint64_t word) { set(self, self->count++, word); }

static void put_all(sink *self, const void *words, size_t count)
{
    if (self->to && count) memcpy(self->to + self->count * WORD, words, count * WORD);
    self->count += count;
}

/* The block of the run's memory that an address is in, and its offset from the block's header; -1: none */
static int find_block(const zd_run *run, uintptr_t address, uint64_t *offset)
{
    int i = 0;
    for (zd_run_memory it = zd_run_memory_first(run); it.block; zd_run_memory_next(&it), i++) {
        *offset = address - (uintptr_t)it.block;
        if (address >= (uintptr_t)it.block && address <= (uintptr_t)(it.block->base + it.block->bytes)) return i;
    }
    return -1;
}

/* The word of the run's system with this value: the address of a function or a table */
static int find_same(const zd_run *run, uint64_t word, uint64_t *index)
{
    const zd_system *system = zd_state_system(run);
    for (*index = 0; *index < sizeof *system / WORD; ++*index)
        if (word_at(system, *index) == word) return 1;
    return 0;
}

/* Writes the entry of a word of a structure; 0: it is a number */
static int put_address(const zd_run *run, size_t i, uint64_t word, sink *to)
{
    const uintptr_t address = (uintptr_t)word;
    uint64_t found;
    const int block = address == word && word > UINT16_MAX ? find_block(run, address, &found) : -1;
    if (block >= 0) {
        put(to, 8 * (uint64_t)i + IN_RUN);
        put(to, (uint64_t)block);
        put(to, found);
        return 1;
    }
    if (address != word || word <= UINT16_MAX || word >> 48 || !find_same(run, word, &found)) return 0;
    put(to, 8 * (uint64_t)i + SAME);
    put(to, found);
    return 1;
}

/* The word of a block at which a plan begins; SIZE_MAX: none is in it */
static size_t find_plan(const zd_run *run, const zd_memory *block)
{
    if (!run->phases) return block == run->memory ? 0 : SIZE_MAX;
    for (const zd_phase *phase = run->phases->first; phase; phase = phase->next)
        if (block == phase->memory) return (size_t)((unsigned char *)phase->plan - block->base) / WORD;
    return SIZE_MAX;
}

size_t zd_state_left_out(const zd_run *run, const zd_memory *block)
{
    return run->phases && block == zd_run_own_memory(run) ? sizeof *run / WORD : 0;
}

static void put_block(const zd_run *run, const zd_memory *block, sink *to)
{
    const size_t plan = find_plan(run, block);
    size_t at = 0, count = 0;       /* place and size of the present entry of numbers; size 0: none */
    for (size_t i = zd_state_left_out(run, block); i < words_of(block); i++) {
        const uint64_t word = word_at(block->base, i);
        const int differs = word != (block->image ? word_at(block->image, i) : 0) && !(i >= plan && follows(i - plan));
        const int is_number = i >= block->bytes / WORD || !block->has_structures[i * WORD / 64];
        if (!differs || (!is_number && put_address(run, i, word, to))) {
            count = 0;
            continue;
        }
        if (!count) {
            at = to->count;
            put(to, 8 * (uint64_t)i + NUMBERS);
            put(to, 0);
        }
        put(to, word);
        set(to, at + 1, ++count);
    }
    put(to, ZD_STATE_END);
}

/* The phases: their number, and of each its state, and 1 with the state at which it was opened. */
static void put_phases(const zd_run *run, sink *to)
{
    const zd_phases *phases = run->phases;
    const size_t at = to->count;
    uint64_t count = 0;
    put(to, 0);
    for (const zd_phase *phase = phases ? phases->first : NULL; phase; phase = phase->next) {
        for (int g = 0; g < phases->full->groups; g++) put(to, (uint64_t)phase->of->state[g]);
        put(to, (uint64_t)phase->is_open);
        if (phase->is_open) put_all(to, phase->opened, zd_state_opening(phases));
        set(to, at, ++count);
    }
}

/* Blocks of a plan that are allocated on demand: their number and sizes, the newest first */
static void put_plan(const zd_run *plan, sink *to)
{
    const size_t at = to->count;
    uint64_t count = 0;
    put(to, 0);
    for (const zd_memory *block = plan->motion.store.last; block; block = block->previous) put(to, block->bytes), set(to, at, ++count);
}

/* True if a plan integrates (p, v) instead of its chosen variables. */
static void put_formulation(const zd_run *plan, sink *to) { put(to, plan->motion.formulation != plan->stepper.chosen.formulation); }

static size_t write_state(const zd_run *run, const char *fingerprint, unsigned char *block)
{
    const size_t nq = run->motion.system.nq, nv = run->motion.system.nv;
    uint64_t header[HEADER] = {[0] = ZD_STATE_MAGIC, [COORDINATES] = nq, [VELOCITIES] = nv};
    sink to = {block, HEADER};
    const zd_inputs *inputs = run->settings.inputs;
    put_all(&to, run->start->base, nq + nv);
    header[PLACES] = zd_inputs_numbers(inputs);
    if (block) zd_inputs_save(inputs, (void *)(block + to.count * WORD));
    to.count += zd_inputs_numbers(inputs);
    put_phases(run, &to);
    const zd_run *plan = NULL;
    for (zd_run_memory it = zd_run_memory_first(run); it.block; zd_run_memory_next(&it)) {
        if (it.plan != plan) put_plan(it.plan, &to);
        plan = it.plan;
    }
    for (zd_run_memory it = zd_run_memory_first(run); it.block; zd_run_memory_next(&it)) put_block(run, it.block, &to);
    if (!run->phases) put_formulation(run, &to);
    const zd_phase *phase = NULL;
    while ((phase = zd_next_open_phase(run, phase))) put_formulation(phase->plan, &to);
    if (!block) return to.count * WORD;
    header[UNIT] = (uint64_t)(zd_closed_form_unit(run->phases ? run->phases->full : &run->motion.system, &run->settings) + 1);
    header[SETTINGS] = zd_state_hash_settings(&((const zd_run *)(const void *)zd_run_own_memory(run)->image)->settings);
    header[ALL_BYTES] = to.count * WORD;
    header[CHECKSUM] = zd_state_hash(0, block + HEADER * WORD, (to.count - HEADER) * WORD);
    zd_state_write_fingerprint(fingerprint, header + FINGERPRINT);
    memcpy(block, header, sizeof header);
    return to.count * WORD;
}

size_t zd_state_size(const zd_run *run) { return write_state(run, "", NULL); }
void zd_state_save(const zd_run *run, const char *fingerprint, void *block) { write_state(run, fingerprint, block); }
