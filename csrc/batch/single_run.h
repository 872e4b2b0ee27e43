/* A run of a batch by itself. */
#ifndef ZD_SINGLE_RUN_H
#define ZD_SINGLE_RUN_H

#include "../workspace.h"
#include "../zerodrift.h"

typedef struct zd_single_run {  /* memory of one run after the other */
    double *p, *v;          /* (nq,), (nv,): its start */
    zd_record record;       /* columns that somebody wants are theirs */
} zd_single_run;

zd_single_run zd_single_run_take(zd_arena *arena, const zd_batch *batch);
char *zd_message_of(const zd_batch *batch, int64_t run);
int zd_batch_is_stopped(const zd_batch *batch);
static inline const void *zd_single_run_data(const zd_batch *batch, int64_t number)
{
    return batch->data ? batch->data + number * batch->doubles : batch->system->data;
}

/* The system of a run, with its own data. */
zd_system zd_single_run_system(const zd_batch *batch, int64_t number);
/* p and v of the memory <- where the run of a system begins, which may be made consistent. */
int zd_single_run_start(const zd_batch *batch, const zd_system *system, const zd_single_run *own, int64_t number);
void zd_single_run_execute(const zd_batch *batch, const zd_single_run *own, int64_t number);

#endif
