/* Counts what the core allocates: every system, formulation, integrator and correction in turn, between creating a run and its end.
 * Linked with --wrap, so that each call of the core itself arrives here. Prints "allocations <when creating> <when running> <label>".
 */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

#include "zerodrift.h"

enum { LARGEST = 64, STEPS = 50 };

static long allocations;

void *__real_malloc(size_t size);
void *__real_calloc(size_t count, size_t size);
void *__real_realloc(void *memory, size_t size);
void *__real_aligned_alloc(size_t alignment, size_t size);

void *__wrap_malloc(size_t size) { return allocations++, __real_malloc(size); }
void *__wrap_calloc(size_t count, size_t size) { return allocations++, __real_calloc(count, size); }
void *__wrap_realloc(void *memory, size_t size) { return allocations++, __real_realloc(memory, size); }
void *__wrap_aligned_alloc(size_t alignment, size_t size) { return allocations++, __real_aligned_alloc(alignment, size); }

static void count(const zd_kind *kind, const zd_system *system, zd_settings settings, const double *p, const double *v)
{
    static double t[STEPS + 1], rows[10][LARGEST * (STEPS + 1)];
    static int counts[2][STEPS + 1];
    zd_record record = {STEPS + 1, 0, t, rows[0], rows[1], rows[2], rows[3], rows[4], rows[5], rows[6], rows[7], rows[8],
                        counts[0], counts[1]};
    int status;
    char message[512];
    allocations = 0;
    zd_run *run = zd_run_create(system, &settings, p, v, &status, message, sizeof message);
    long creating = allocations;
    allocations = 0;
    if (run) status = zd_run_advance(run, &record, 1e9);
    printf("allocations %ld %ld %s, %s, %s, status %d, %" PRId64 " rows\n", creating, allocations, kind->card.name,
           zd_entry_card(ZD_FORMULATIONS, settings.formulation)->name, zd_entry_card(ZD_INTEGRATORS, settings.integrator)->name, status,
           record.samples);
    zd_run_free(run);
}

static void count_with_settings(const zd_kind *kind, const zd_system *system, const double *p, const double *v)
{
    zd_settings settings = {.t1 = 0.5, .step = 0.5 / STEPS, .save_every = 1};
    for (settings.formulation = 0; settings.formulation < zd_entry_count(ZD_FORMULATIONS); settings.formulation++)
        for (settings.integrator = 0; settings.integrator < zd_entry_count(ZD_INTEGRATORS); settings.integrator++)
            for (int all = 0; all < 2 && zd_suits(system, settings.integrator); all++) {
                for (int row = 0; row < zd_entry_count(ZD_CORRECTIONS); row++) {
                    settings.correction[row] = zd_initial(zd_entry_card(ZD_CORRECTIONS, row));
                    settings.correction[row].given = all && !(zd_correction_requires(row) & ~system->provides);
                }
                char message[512];
                if (zd_check_methods_agree(&settings, message, sizeof message)) printf("methods that disagree: %s\n", message);
                else count(kind, system, settings, p, v);
            }
}

int main(void)
{
    for (int row = 0; row < zd_entry_count(ZD_SYSTEMS); row++) {
        const zd_kind *kind = zd_kind_of(row);
        double parameters[LARGEST], constants[LARGEST], p[LARGEST], v[LARGEST];
        int n = 0;
        for (int i = 0; i < kind->parameters; i++)
            for (int j = 0; j < kind->parameter[i].size; j++)
                parameters[n++] = kind->parameter[i].initial ? kind->parameter[i].initial[j] : strtod("nan", NULL);
        if (n > LARGEST || kind->constants > LARGEST || kind->prepare(parameters, constants)) return 1;
        zd_system system = kind->system;
        system.data = constants;
        kind->start(parameters, p, v);
        count_with_settings(kind, &system, p, v);
    }
    return 0;
}
