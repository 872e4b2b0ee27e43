/* Many runs in one call: each begins where the tables say, and ends by itself, whatever happens to the others. */
#include <stdio.h>
#include <string.h>

#include "../workspace.h"
#include "../zerodrift.h"

static const double SLICE = 0.02;       /* s: so soon is seen that nobody waits any more */

typedef struct memory {     /* of one run after the other */
    double *p, *v;          /* (nq,), (nv,): its start */
    zd_record record;       /* columns that somebody wants are theirs */
} memory;

static int count_constraints(const zd_system *system) { return system->mh + system->mn; }

static int width_of(const zd_outputs *outputs, const zd_system *system)
{
    int width = 0;
    const zd_measures *measures = (outputs->of ? outputs->of : system)->measures;
    for (int i = 0; i < outputs->count; i++) width += measures->measure[outputs->measure[i]].size;
    return width;
}

static memory lay_out(zd_arena *arena, const zd_batch *batch)
{
    const zd_system *system = batch->system;
    const zd_outputs *outputs = batch->settings->outputs;
    const size_t rows = (size_t)batch->capacity, nq = (size_t)system->nq, nv = (size_t)system->nv, m = (size_t)count_constraints(system);
    return (memory){
        .p = zd_take_doubles(arena, nq),
        .v = zd_take_doubles(arena, nv),
        .record = {
            .capacity = batch->capacity,
            .t = zd_take_doubles(arena, rows),
            .p = zd_take_doubles(arena, rows * nq),
            .v = zd_take_doubles(arena, rows * nv),
            .multipliers = zd_take_doubles(arena, rows * m),
            .position_violation = zd_take_doubles(arena, rows * (size_t)system->mh),
            .velocity_violation = zd_take_doubles(arena, rows * m),
            .kinetic = zd_take_doubles(arena, rows),
            .potential = zd_take_doubles(arena, rows),
            .input = zd_take_doubles(arena, rows),
            .energy_violation = zd_take_doubles(arena, rows),
            .iterations = zd_take(arena, rows * sizeof(int)),
            .energy_skipped = zd_take(arena, rows * sizeof(int)),
            .outputs = outputs ? zd_take_doubles(arena, rows * (size_t)width_of(outputs, system)) : NULL,
        },
    };
}

static void redirect(double **column, double *wanted, int64_t run, int64_t size)
{
    if (wanted) *column = wanted + run * size;
}

/* The record of a run: what is wanted of it goes where it is wanted. */
static zd_record record_of(const zd_batch *batch, const memory *own, int64_t run)
{
    const zd_system *system = batch->system;
    const int64_t rows = batch->capacity;
    zd_record record = own->record;
    redirect(&record.t, batch->t, run, rows);
    redirect(&record.p, batch->p, run, rows * system->nq);
    redirect(&record.v, batch->v, run, rows * system->nv);
    redirect(&record.multipliers, batch->multipliers, run, rows * count_constraints(system));
    if (record.outputs) redirect(&record.outputs, batch->outputs, run, rows * width_of(batch->settings->outputs, system));
    return record;
}

static char *message_of(const zd_batch *batch, int64_t run) { return batch->message + run * batch->message_size; }

static int is_stopped(const zd_batch *batch) { return batch->stop && *(const volatile int *)batch->stop; }

/* Where a run begins */
static int set_start(const zd_batch *batch, const zd_system *system, const memory *own, int64_t run)
{
    memcpy(own->p, batch->p0 + run * system->nq, (size_t)system->nq * sizeof(double));
    memcpy(own->v, batch->v0 + run * system->nv, (size_t)system->nv * sizeof(double));
    if (!batch->assembly) return ZD_DONE;
    return zd_project(system, batch->assembly, batch->settings->t0, own->p, own->v, batch->hold_p, batch->hold_v, NULL,
                      message_of(batch, run), batch->message_size);
}

static void advance(const zd_batch *batch, zd_run *run, zd_record *record, int64_t number)
{
    int status = ZD_PAUSED;
    while (status == ZD_PAUSED && !is_stopped(batch)) status = zd_run_advance(run, record, SLICE);
    batch->way[number] = ZD_BY_ITSELF;
    batch->rows[number] = record->rows;
    batch->status[number] = status;
    batch->statistics[number] = *zd_run_statistics(run);
    batch->kinetic[number] = zd_run_kinetic(run);
    batch->energy_error[number] = zd_run_energy_error(run);
    if (status) snprintf(message_of(batch, number), (size_t)batch->message_size, "%s", zd_run_message(run));
}

static void run_by_itself(const zd_batch *batch, const memory *own, int64_t number)
{
    zd_system system = *batch->system;
    zd_record record = record_of(batch, own, number);
    if (batch->data) system.data = batch->data + number * batch->doubles;
    batch->status[number] = set_start(batch, &system, own, number);
    if (batch->status[number]) return;
    zd_run *run = zd_run_create(&system, batch->settings, own->p, own->v, &batch->status[number], message_of(batch, number),
                                batch->message_size);
    if (run) advance(batch, run, &record, number);
    zd_run_free(run);
}

static void prepare(const zd_batch *batch)
{
    for (int64_t i = 0; i < batch->runs; i++) {
        batch->rows[i] = 0;
        batch->status[i] = ZD_PAUSED;
        batch->way[i] = ZD_NOT_BEGUN;
        batch->statistics[i] = (zd_statistics){0};
        batch->kinetic[i] = batch->energy_error[i] = 0;
        *message_of(batch, i) = '\0';
    }
}

int zd_batch_run(const zd_batch *batch)
{
    zd_arena arena = {NULL, 0};
    lay_out(&arena, batch);
    arena = (zd_arena){zd_allocate(arena.used), 0};
    prepare(batch);
    if (!arena.base) return ZD_NO_MEMORY;
    const memory own = lay_out(&arena, batch);
    for (int64_t i = 0; i < batch->runs && !is_stopped(batch); i++) run_by_itself(batch, &own, i);
    zd_release(arena.base);
    return ZD_DONE;
}
