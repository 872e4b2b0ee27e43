/* Fuzz target: blocks of mechanisms, changed at random, must be refused with a sentence or make a mechanism that can be run. Whatever
 * they are, nothing crashes, leaks or runs on.
 *
 *     fuzz_block COUNT SEED FILE...       COUNT changed copies of each block
 */
#include <float.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "block/block.h"

enum { MESSAGE = 320, LARGEST = 1 << 20, STEPS = 4 };

#define EXPECT(condition) ((condition) ? (void)0 : fail(#condition, __LINE__))

static void fail(const char *what, int line)
{
    fprintf(stderr, "line %d: expected %s\n", line, what);
    abort();
}

static uint64_t state;

static unsigned below(unsigned n)
{
    state ^= state << 13, state ^= state >> 7, state ^= state << 17;
    return (unsigned)(state >> 33) % n;
}

static double number(double old)
{
    static const double special[] = {0, -1, 1, 2, 3, -2, 7, 0.5, NAN, INFINITY, -INFINITY, DBL_MAX, 5e-324,
                                     1e-12, 1e8, 0x1p24, 0x1p31, 0x1p53, 1e300};
    const unsigned kind = below(8);
    if (kind == 0) return old + 1;
    if (kind == 1) return old - 1;
    if (kind == 2) return -old;
    if (kind == 3) return old * (1 + (double)below(1000) / 500);
    return special[below(sizeof special / sizeof special[0])];
}

/* Some words become others, a byte too, and rarely the block is cut. Returns its size. */
static size_t spoil(unsigned char *block, size_t size)
{
    const unsigned words = (unsigned)(size / sizeof(double));
    for (unsigned k = 1 + below(4); k; k--) {
        const unsigned at = below(3) ? below(words) : below(words < 40 ? words : 40);
        double word;
        memcpy(&word, block + at * sizeof word, sizeof word);
        word = number(word);
        memcpy(block + at * sizeof word, &word, sizeof word);
    }
    if (below(8) == 0) block[below((unsigned)size)] = (unsigned char)below(256);
    if (below(16)) return size;
    const size_t cut = below((unsigned)size);
    const double counted = (double)(cut / sizeof(double));
    if (cut >= 24 && below(2)) memcpy(block + 16, &counted, sizeof counted);
    return below(2) ? cut : cut / sizeof(double) * sizeof(double);
}

/* Reads measures at the start, whatever they need of accelerations. */
static void read_measures(const zd_system *system, const double *p, const double *v)
{
    const int count = system->measures->count, m = system->mh + system->mn;
    double *zeros = calloc((size_t)(system->nv + m + 1), sizeof *zeros);
    double *scratch = calloc((size_t)system->measures->scratch + 1, sizeof *scratch);
    for (int i = 0; i < count && i < 100; i++) {
        double *value = calloc((size_t)system->measures->measure[i].size, sizeof *value), t = 0;
        zd_measure_states(system, NULL, 1, &i, 1, &t, p, v, zeros, zeros + system->nv, &(zd_measured){.value = value}, scratch);
        free(value);
    }
    free(zeros);
    free(scratch);
}

static void run(zd_block *block, const zd_settings *settings, const double *p, const double *v)
{
    char message[MESSAGE] = "";
    int status;
    zd_run *run = zd_run_create(zd_block_system(block), settings, p, v, &status, message, MESSAGE);
    EXPECT(run || (status < 0 && *message));
    if (!run) return;
    const zd_system *system = zd_block_system(block);
    int components = 1;
    for (int i = 0; settings->outputs && i < settings->outputs->count; i++)
        components += system->measures->measure[settings->outputs->measure[i]].size;
    const size_t m = (size_t)(system->mh + system->mn), rows = STEPS + 2;
    double *memory = calloc(rows * ((size_t)system->nq + (size_t)system->nv + 3 * m + 5 + (size_t)components), sizeof *memory), *at = memory;
    int counts[2 * (STEPS + 2)];
    zd_record record = {.capacity = (int64_t)rows, .iterations = counts, .energy_skipped = counts + rows};
#define TAKE(member, width) record.member = at, at += rows * (size_t)(width)
    TAKE(t, 1), TAKE(p, system->nq), TAKE(v, system->nv), TAKE(multipliers, m), TAKE(position_violation, system->mh);
    TAKE(velocity_violation, m), TAKE(kinetic, 1), TAKE(potential, 1), TAKE(input, 1), TAKE(energy_violation, 1), TAKE(outputs, components);
#undef TAKE
    status = zd_run_advance(run, &record, 0.05);
    EXPECT(status >= 0 || *zd_run_message(run));
    zd_run_free(run);
    free(memory);
}

static void try_block(const unsigned char *data, size_t size)
{
    char message[MESSAGE] = "";
    zd_block *block = zd_block_create(data, size, message, MESSAGE);
    EXPECT(block || *message);
    if (!block) return;
    zd_settings settings;
    const zd_system *system = zd_block_system(block);
    for (int row = 0; row < system->mh + system->mn; row++) system->name_constraint(system->names, row, message, MESSAGE);
    for (int i = 0; i < zd_block_inputs(block); i++) zd_block_set_input(block, i, 0.3);
    for (int i = 0; i < zd_block_parameters(block); i++) zd_block_set_parameter(block, i, 0.3);
    const double *p = zd_block_start(block);
    message[0] = 0;
    EXPECT(!zd_block_settings(block, &settings, message, MESSAGE) || *message);
    settings.t1 = settings.t0 + STEPS * (settings.steps == ZD_FIXED_STEPS ? settings.step : 0.01);
    settings.max_steps = 20;
    if (p) read_measures(system, p, p + system->nq);
    if (p && !*message) run(block, &settings, p, p + system->nq);
    zd_block_free(block);
}

static size_t read_file(const char *path, unsigned char *to)
{
    FILE *file = fopen(path, "rb");
    EXPECT(file);
    const size_t size = fread(to, 1, LARGEST, file);
    EXPECT(size && size < LARGEST);
    fclose(file);
    return size;
}

int main(int arguments, char **argument)
{
    EXPECT(arguments > 3);
    state = strtoull(argument[2], NULL, 10) * 0x9E3779B97F4A7C15u + 1;
    unsigned char *given = malloc(LARGEST), *changed = malloc(LARGEST);
    EXPECT(given && changed);
    for (int file = 3; file < arguments; file++) {
        const size_t size = read_file(argument[file], given);
        try_block(given, size);
        for (long k = strtol(argument[1], NULL, 10); k > 0; k--) {
            memcpy(changed, given, size);
            try_block(changed, spoil(changed, size));
        }
    }
    free(given);
    free(changed);
    return 0;
}
