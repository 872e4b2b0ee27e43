/* Batches: many runs in one call, in lanes or individually. */
#pragma once

#include "../workspace.h"
#include "../zerodrift.h"

/* Individual execution of a run of a batch. */

typedef struct zd_single_run {  /* memory of a run, reused by the next */
    double *p, *v;          /* (nq,), (nv,): state at the start */
    zd_record record;       /* columns; those requested are in the batch's own arrays */
} zd_single_run;

zd_single_run zd_single_run_create(zd_arena *arena, const zd_batch *batch);
char *zd_message_of(const zd_batch *batch, int64_t run);
int zd_batch_is_stopped(const zd_batch *batch);
static inline const void *zd_single_run_data(const zd_batch *batch, int64_t number)
{
    return batch->data ? batch->data + number * batch->doubles : batch->system->data;
}

/* System of a run, with its own data. */
zd_system zd_single_run_system(const zd_batch *batch, int64_t number);
/* p, v of the memory <- state at the start of a run, projected onto the constraints if required. */
int zd_single_run_start(const zd_batch *batch, const zd_system *system, const zd_single_run *own, int64_t number);
void zd_single_run_execute(const zd_batch *batch, const zd_single_run *own, int64_t number);

/* Samples at the events of a batch. */

/* Run whose events are recorded: the data of zd_events. */
typedef struct zd_event_samples {
    const zd_batch *batch;
    int64_t run;
} zd_event_samples;

/* `found` of zd_events: records an event of that run. */
int zd_event_samples_add(void *found, int event, double t, const double *p, const double *v);
/* Number of occurrences of an event of the run so far; writable. */
int64_t *zd_event_samples_count(const zd_batch *batch, int64_t run, int event);
/* Resets these numbers to 0. */
void zd_event_samples_clear(const zd_batch *batch, int64_t run);

/* Runs of a batch in vector lanes. */

/* True if lanes can make the corrections: none, or positions and velocities in the mass metric, and those that follow. */
int zd_lanes_serve_run(const zd_run *run);
/* True if the system and the settings of the batch admit runs in lanes. */
int zd_lanes_serve(const zd_batch *batch);
/* Makes all runs: in lanes, or individually those that these cannot make. */
int zd_run_side_by_side(const zd_batch *batch, const zd_single_run *own);
