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

#include "../paths/path.h"
#include "run.h"

#define MAGIC UINT64_C(0x316574617473647a)      /* "zdstate1" on machines with little-endian words, which others refuse */
#define END UINT64_MAX                          /* end of the entries of a block */

enum { FINGERPRINT_WORDS = 8, WORD = sizeof(uint64_t) };
enum { ALL_BYTES = 1, CHECKSUM, FINGERPRINT, UNIT = FINGERPRINT + FINGERPRINT_WORDS, SETTINGS, COORDINATES, VELOCITIES, PLACES, KEPT,
       BLOCKS, DEPENDENT, HEADER };

/* Kinds of words that differ: first word of an entry is 8 * index + kind. */
enum kind {
    NUMBERS,                /* their count, and the words */
    IN_RUN,                 /* an address in the run's memory: block, and offset from its header */
    SAME                    /* the value of a word of the run's zd_system: its index */
};

/* Words of zd_run that follow from the elimination order and from DEPENDENT, as zd_path_bind() sets them. */
#define OF(member) offsetof(zd_run, motion.member)
static const size_t FOLLOWING[] = {OF(formulation), OF(equations), OF(rate.evaluate), OF(rate.closed_form), OF(rate.vdot), OF(rate.expand),
                                   OF(rate.reduce)};

static int follows(size_t i)
{
    int does = 0;
    for (size_t k = 0; k < sizeof FOLLOWING / sizeof *FOLLOWING; k++) does |= i == FOLLOWING[k] / WORD;
    return does;
}

/* ---- memory of a run ---- */

static int count_blocks(const zd_run *run)
{
    int count = 1;
    for (const zd_memory *block = run->motion.store.last; block; block = block->previous) count++;
    return count;
}

/* Block i: its own memory, then what was allocated on demand, the oldest first. */
static zd_memory *block_of(const zd_run *run, int i)
{
    zd_memory *block = run->motion.store.last;
    if (!i) return run->memory;
    for (int k = count_blocks(run) - 1; k > i; k--) block = block->previous;
    return block;
}

static uint64_t word_at(const void *memory, size_t i)
{
    uint64_t word;
    memcpy(&word, (const unsigned char *)memory + i * WORD, sizeof word);
    return word;
}

/* Words of a block; of one that is not in the image, with the record of where it has numbers, which follows it. */
static size_t words_of(const zd_memory *block)
{
    const size_t lines = block->image ? 0 : block->bytes / 64;
    return block->bytes / WORD + (lines + WORD - 1) / WORD;
}

int zd_state_begin(zd_run *run, const double *p0, const double *v0)
{
    const size_t nq = run->motion.system.nq, nv = run->motion.system.nv;
    run->start = zd_memory_create((nq + nv) * sizeof *p0);
    if (!run->start) return ZD_NO_MEMORY;
    memcpy(run->start->base, p0, nq * sizeof *p0);
    memcpy(run->start->base + nq * sizeof *p0, v0, nv * sizeof *v0);
    for (int i = 0; i < count_blocks(run); i++)
        if (zd_memory_save(block_of(run, i))) return ZD_NO_MEMORY;
    return ZD_DONE;
}

/* Words of inputs in the data of the system, which belong to the run's state. */
static size_t words_of_place(const zd_input_slot *place) { return place->is_speed ? 3 : 1; }

static size_t words_of_places(const zd_inputs *inputs)
{
    size_t words = 0;
    for (int i = 0; inputs && i < inputs->places; i++) words += words_of_place(inputs->place + i);
    return words;
}

/* ---- agreement of a state and a run ---- */

static uint64_t hash(uint64_t so_far, const void *data, size_t bytes)      /* FNV-1a */
{
    for (size_t i = 0; i < bytes; i++) so_far = (so_far ^ ((const unsigned char *)data)[i]) * UINT64_C(0x100000001b3);
    return so_far;
}

static uint64_t hash_given(uint64_t so_far, const zd_parameter_values *given)
{
    so_far = hash(so_far, &given->given, sizeof given->given);
    return given->given ? hash(so_far, given->value, sizeof given->value) : so_far;
}

static uint64_t hash_settings(const zd_settings *settings)
{
    const double numbers[] = {
        settings->formulation, settings->integrator, settings->t0, settings->t1, settings->steps, settings->step, settings->rtol,
        settings->atol, settings->first_step, settings->max_step, settings->max_move, (double)settings->max_steps,
        (double)settings->save_every, (double)settings->t_evals, settings->on_singular, settings->closed_form, settings->given_jacobian,
        settings->is_open, settings->events ? settings->events->count : -1, settings->outputs ? settings->outputs->count : -1,
        settings->inputs ? settings->inputs->jumps : 0, settings->inputs ? settings->inputs->ramp : 0,
    };
    uint64_t found = hash(UINT64_C(0xcbf29ce484222325), numbers, sizeof numbers);
    found = hash_given(hash_given(found, &settings->of_formulation), &settings->of_integrator);
    for (int i = 0; i < ZD_CORRECTIONS_MAX; i++) found = hash_given(found, &settings->correction[i]);
    return settings->t_eval ? hash(found, settings->t_eval, settings->t_evals * sizeof *settings->t_eval) : found;
}

static void write_fingerprint(const char *fingerprint, uint64_t words[FINGERPRINT_WORDS])
{
    snprintf((char *)words, FINGERPRINT_WORDS * WORD, "%s", fingerprint);
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
    for (int i = 0; i < count_blocks(run); i++) {
        const zd_memory *block = block_of(run, i);
        *offset = address - (uintptr_t)block;
        if (address >= (uintptr_t)block && address <= (uintptr_t)(block->base + block->bytes)) return i;
    }
    return -1;
}

/* The word of the run's system with this value: the address of a function or a table */
static int find_same(const zd_run *run, uint64_t word, uint64_t *index)
{
    for (*index = 0; *index < sizeof run->motion.system / WORD; ++*index)
        if (word_at(&run->motion.system, *index) == word) return 1;
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

static void put_block(const zd_run *run, const zd_memory *block, sink *to)
{
    size_t at = 0, count = 0;       /* place and size of the present entry of numbers; size 0: none */
    put(to, block->bytes);
    for (size_t i = 0; i < words_of(block); i++) {
        const uint64_t word = word_at(block->base, i);
        const int differs = word != (block->image ? word_at(block->image, i) : 0) && !(block == run->memory && follows(i));
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
    put(to, END);
}

static size_t write_state(const zd_run *run, const char *fingerprint, unsigned char *block)
{
    const size_t nq = run->motion.system.nq, nv = run->motion.system.nv;
    uint64_t header[HEADER] = {[0] = MAGIC, [COORDINATES] = nq, [VELOCITIES] = nv, [BLOCKS] = (uint64_t)count_blocks(run),
                               [DEPENDENT] = run->motion.formulation != run->stepper.chosen.formulation};
    sink to = {block, HEADER};
    const zd_inputs *inputs = run->settings.inputs;
    put_all(&to, run->start->base, nq + nv);
    header[PLACES] = words_of_places(inputs);
    for (int i = 0; inputs && i < inputs->places; i++) put_all(&to, inputs->place[i].place, words_of_place(inputs->place + i));
    for (int i = 0; i < count_blocks(run); i++) {
        header[KEPT] += block_of(run, i)->image != NULL;
        put_block(run, block_of(run, i), &to);
    }
    if (!block) return to.count * WORD;
    header[UNIT] = (uint64_t)(zd_closed_form_unit(&run->motion.system, &run->settings) + 1);
    header[SETTINGS] = hash_settings(&((const zd_run *)(const void *)run->memory->image)->settings);
    header[ALL_BYTES] = to.count * WORD;
    header[CHECKSUM] = hash(0, block + HEADER * WORD, (to.count - HEADER) * WORD);
    write_fingerprint(fingerprint, header + FINGERPRINT);
    memcpy(block, header, sizeof header);
    return to.count * WORD;
}

size_t zd_state_size(const zd_run *run) { return write_state(run, "", NULL); }
void zd_state_save(const zd_run *run, const char *fingerprint, void *block) { write_state(run, fingerprint, block); }

/* ---- restoring ---- */

typedef struct source {     /* words that are read; 0 beyond the end */
    const unsigned char *from;
    size_t count, next;
} source;

static uint64_t get(source *self) { return self->next < self->count ? word_at(self->from, self->next++) : (self->next++, 0); }

/* The word that an entry of one address stands for. */
static uint64_t decoded(const zd_run *run, enum kind kind, uint64_t first, uint64_t offset)
{
    if (kind == IN_RUN) return first < (uint64_t)count_blocks(run) ? (uint64_t)((uintptr_t)block_of(run, (int)first) + offset) : 0;
    return first < sizeof run->motion.system / WORD ? word_at(&run->motion.system, first) : 0;
}

/* Applies the entries of a block; 0: they do not fit it. */
static int apply(const zd_run *run, zd_memory *block, source *from)
{
    for (uint64_t head = get(from); head != END; head = get(from)) {
        const enum kind kind = (enum kind)(head % 8);
        const uint64_t i = head / 8, first = get(from), count = kind == NUMBERS ? first : 1, words = words_of(block);
        if (from->next > from->count || i >= words || count > words - i) return 0;
        for (uint64_t k = 0; k < count; k++) {
            const uint64_t word = kind == NUMBERS ? get(from) : decoded(run, kind, first, kind == IN_RUN ? get(from) : 0);
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
    uint64_t expected[FINGERPRINT_WORDS] = {0};
    write_fingerprint(fingerprint, expected);
    if (bytes < HEADER * WORD || header[0] != MAGIC) return "a saved state must be what was saved of a run, by this version";
    if (header[ALL_BYTES] != bytes) return "a saved state must be whole: some of its bytes are missing, or there are more";
    if (hash(0, block + HEADER * WORD, bytes - HEADER * WORD) != header[CHECKSUM]) return "a saved state must be unchanged: it is damaged";
    if (memcmp(expected, header + FINGERPRINT, sizeof expected) || header[COORDINATES] != (uint64_t)system->nq
        || header[VELOCITIES] != (uint64_t)system->nv || header[PLACES] != words_of_places(settings->inputs))
        return "a saved state must be of the same system, with the same parameters, and of a version of zerodrift with the same layout";
    if (header[UNIT] != (uint64_t)(zd_closed_form_unit(system, settings) + 1))
        return UNITS[header[UNIT] % (sizeof UNITS / sizeof *UNITS)];
    return NULL;
}

static void get_inputs(const zd_inputs *inputs, source *from)
{
    for (int i = 0; inputs && i < inputs->places; i++)
        for (size_t k = 0; k < words_of_place(inputs->place + i); k++) {
            const uint64_t word = get(from);
            memcpy(inputs->place[i].place + k, &word, sizeof word);
        }
    if (inputs) zd_inputs_derive(inputs);
}

/* Adds the blocks that were allocated on demand, and applies all entries. */
static int fill(zd_run *run, const uint64_t *header, source *from)
{
    get_inputs(run->settings.inputs, from);
    source sizes = *from;
    if ((uint64_t)count_blocks(run) != header[KEPT]) return ZD_BAD_ARGUMENT;
    for (uint64_t i = 0; i < header[BLOCKS]; i++) {
        const uint64_t bytes = get(&sizes);
        if (i < header[KEPT] ? block_of(run, (int)i)->bytes != bytes : !zd_store_add(&run->motion.store, bytes)) return ZD_NO_MEMORY;
        for (uint64_t head = get(&sizes); head != END && sizes.next <= sizes.count; head = get(&sizes)) {
            const uint64_t words = head % 8 == NUMBERS ? get(&sizes) : head % 8 == IN_RUN ? 2 : 1;
            sizes.next += words;
        }
    }
    for (uint64_t i = 0; i < header[BLOCKS]; i++) {
        get(from);
        if (!apply(run, block_of(run, (int)i), from)) return ZD_BAD_ARGUMENT;
    }
    if (header[DEPENDENT]) run->motion.formulation = run->stepper.dependent.formulation;
    zd_path_bind(&run->motion);
    return ZD_DONE;
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
        const int agree = run && header[SETTINGS] == hash_settings(&run->settings);
        if (agree && !*status) *status = fill(run, header, &from);
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
