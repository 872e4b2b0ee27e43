/* Samples at the events of a batch. */
#ifndef ZD_EVENT_SAMPLES_H
#define ZD_EVENT_SAMPLES_H

#include "../zerodrift.h"

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

#endif
