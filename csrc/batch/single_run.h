/* Individual execution of a run of a batch. */
#ifndef ZD_SINGLE_RUN_H
#define ZD_SINGLE_RUN_H

#include "../workspace.h"
#include "../zerodrift.h"

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

#endif
