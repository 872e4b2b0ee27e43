/* Where the events of a batch have happened. */
#ifndef ZD_EVENT_SAMPLES_H
#define ZD_EVENT_SAMPLES_H

#include "../zerodrift.h"

/* Whose events are written down, */
typedef struct zd_event_samples {
    const zd_batch *batch;
    int64_t run;
} zd_event_samples;

/* as `found` of zd_events has it, whose data is such a run. */
int zd_event_samples_add(void *found, int event, double t, const double *p, const double *v);
/* How often an event of the run has happened so far; a place to count in. */
int64_t *zd_event_samples_count(const zd_batch *batch, int64_t run, int event);
/* As if none had happened. */
void zd_event_samples_clear(const zd_batch *batch, int64_t run);

#endif
