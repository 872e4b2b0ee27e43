/* Where the events of a batch have happened. */
#ifndef ZD_FOUND_H
#define ZD_FOUND_H

#include "../zerodrift.h"

/* Whose events are written down, */
typedef struct zd_found {
    const zd_batch *batch;
    int64_t run;
} zd_found;

/* as `found` of zd_events has it, whose data is such a run. */
int zd_found_note(void *found, int event, double t, const double *p, const double *v);
/* How often an event of the run has happened so far; a place to count in. */
int64_t *zd_found_count(const zd_batch *batch, int64_t run, int event);
/* As if none had happened. */
void zd_found_forget(const zd_batch *batch, int64_t run);

#endif
