/* Individual execution of a run of a batch: created, advanced and freed as any other run. */
#include "batch.h"

#include <math.h>
#include <stdio.h>

#include "../linalg/small.h"
#include "../step/step_loop.h"

static const double SLICE = 0.02;       /* s: interval at which a stop request is checked */

static int count_constraints(const zd_system *system) { return system->mh + system->mn; }

static int width_of(const zd_outputs *outputs, const zd_system *system)
{
    int width = 0;
    const zd_measures *measures = (outputs->of ? outputs->of : system)->measures;
    for (int i = 0; i < outputs->count; i++) width += measures->measure[outputs->measure[i]].size;
    return width;
}

zd_single_run zd_single_run_create(zd_arena *arena, const zd_batch *batch)
{
    const zd_system *system = batch->system;
    const zd_outputs *outputs = batch->settings->outputs;
    const size_t rows = batch->capacity, nq = system->nq, nv = system->nv, m = count_constraints(system);
    return (zd_single_run){
        .p = zd_arena_doubles(arena, nq),
        .v = zd_arena_doubles(arena, nv),
        .record = {
            .capacity = batch->capacity,
            .t = zd_arena_doubles(arena, rows),
            .p = zd_arena_doubles(arena, rows * nq),
            .v = zd_arena_doubles(arena, rows * nv),
            .multipliers = zd_arena_doubles(arena, rows * m),
            .position_violation = zd_arena_doubles(arena, rows * (size_t)system->mh),
            .velocity_violation = zd_arena_doubles(arena, rows * m),
            .kinetic = zd_arena_doubles(arena, rows),
            .potential = zd_arena_doubles(arena, rows),
            .input = zd_arena_doubles(arena, rows),
            .energy_violation = zd_arena_doubles(arena, rows),
            .iterations = zd_arena_ints(arena, rows),
            .energy_skipped = zd_arena_ints(arena, rows),
            .outputs = outputs ? zd_arena_doubles(arena, rows * (size_t)width_of(outputs, system)) : NULL,
        },
    };
}

static void redirect(double **column, double *wanted, int64_t run, int64_t size)
{
    if (wanted) *column = wanted + run * size;
}

/* Record of a run; requested columns are redirected to the batch's arrays. */
static zd_record record_of(const zd_batch *batch, const zd_single_run *own, int64_t run)
{
    const zd_system *system = batch->system;
    const int64_t rows = batch->capacity;
    zd_record record = own->record;
    redirect(&record.t, batch->t, run, rows);
    redirect(&record.p, batch->p, run, rows * system->nq);
    redirect(&record.v, batch->v, run, rows * system->nv);
    redirect(&record.input, batch->input, run, rows);
    if (batch->iterations) record.iterations = batch->iterations + run * rows;
    if (batch->energy_skipped) record.energy_skipped = batch->energy_skipped + run * rows;
    redirect(&record.multipliers, batch->multipliers, run, rows * count_constraints(system));
    if (record.outputs) redirect(&record.outputs, batch->outputs, run, rows * width_of(batch->settings->outputs, system));
    return record;
}

char *zd_message_of(const zd_batch *batch, int64_t run)
{
    return batch->message + run * batch->message_size;
}

int zd_batch_is_stopped(const zd_batch *batch)
{
    return batch->stop && *(const volatile int *)batch->stop;
}

int zd_single_run_start(const zd_batch *batch, const zd_system *system, const zd_single_run *own, int64_t run)
{
    if (batch->p0) zd_copy_all(system->nq, batch->p0 + run * system->nq, own->p);
    if (batch->v0) zd_copy_all(system->nv, batch->v0 + run * system->nv, own->v);
    if (!batch->assembly) return ZD_DONE;
    return zd_project(system, batch->assembly, batch->settings->t0, own->p, own->v, batch->hold_p, batch->hold_v, NULL,
                      zd_message_of(batch, run), batch->message_size);
}

static double largest_of(const double *values, int64_t count)
{
    double largest = count ? 0 : NAN;
    for (int64_t i = 0; i < count; i++)
        if (!(fabs(values[i]) <= largest) && !isnan(largest)) largest = fabs(values[i]);
    return largest;
}

static void measure(const zd_batch *batch, const zd_run *run, const zd_record *record, int64_t number)
{
    const zd_system *system = batch->system;
    if (batch->omega_h) batch->omega_h[number] = zd_run_omega_h(run);
    if (batch->position_violation) batch->position_violation[number] = largest_of(record->position_violation, record->samples * system->mh);
    if (batch->velocity_violation)
        batch->velocity_violation[number] = largest_of(record->velocity_violation, record->samples * count_constraints(system));
}

static void advance(const zd_batch *batch, zd_run *run, zd_record *record, int64_t number)
{
    const double begin = batch->seconds ? zd_seconds_now() : 0;
    int status = ZD_PAUSED;
    while (status == ZD_PAUSED && !zd_batch_is_stopped(batch)) status = zd_run_advance(run, record, SLICE);
    if (batch->seconds) batch->seconds[number] = zd_seconds_now() - begin;
    batch->way[number] = status == ZD_FULL ? ZD_UNUSUAL : ZD_BY_ITSELF;     /* changes of phase have samples of their own */
    batch->samples[number] = record->samples;
    batch->status[number] = status = status == ZD_FULL ? ZD_DONE : status;
    batch->statistics[number] = *zd_run_statistics(run);
    batch->kinetic[number] = zd_run_kinetic(run);
    batch->energy_error[number] = zd_run_energy_error(run);
    measure(batch, run, record, number);
    if (status) snprintf(zd_message_of(batch, number), batch->message_size, "%s", zd_run_message(run));
}

zd_system zd_single_run_system(const zd_batch *batch, int64_t number)
{
    zd_system system = *batch->system;
    system.data = zd_single_run_data(batch, number);
    return system;
}

/* Settings of the run, its own or common; events are recorded for this run. */
static zd_settings settings_of(const zd_batch *batch, zd_event_samples *found, zd_events *events)
{
    zd_settings settings = batch->settings[batch->settings_differ ? found->run : 0];
    if (!settings.events) return settings;
    *events = *settings.events;
    events->found = zd_event_samples_add;
    events->data = found;
    settings.events = events;
    return settings;
}

static void run_of(const zd_batch *batch, const zd_single_run *own, const zd_system *system, int64_t number)
{
    zd_record record = record_of(batch, own, number);
    zd_event_samples found = {batch, number};
    zd_events events;
    const zd_settings settings = settings_of(batch, &found, &events);
    zd_event_samples_clear(batch, number);
    batch->status[number] = zd_single_run_start(batch, system, own, number);
    if (batch->status[number]) return;
    zd_run *run = zd_run_create(system, &settings, own->p, own->v, &batch->status[number], zd_message_of(batch, number),
                                batch->message_size);
    if (run) advance(batch, run, &record, number);
    zd_run_free(run);
}

void zd_single_run_execute(const zd_batch *batch, const zd_single_run *own, int64_t number)
{
    const zd_system system = zd_single_run_system(batch, number);
    if (batch->settings->inputs) {      /* their memory is common to all runs */
        batch->way[number] = ZD_UNUSUAL, batch->status[number] = ZD_DONE;
        return;
    }
    if (!batch->family) {
        run_of(batch, own, &system, number);
        return;
    }
    void *made;
    const zd_system *mine = batch->family->make(batch->family->of, number, own->p, own->v, &made);
    if (mine) run_of(batch, own, mine, number);
    else batch->way[number] = ZD_UNUSUAL, batch->status[number] = ZD_DONE;
    batch->family->free(made);
}
