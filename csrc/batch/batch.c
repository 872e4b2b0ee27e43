/* Many runs in one call: each begins at its entry of the arrays and ends independently of the others. */
#include "batch.h"

static void prepare(const zd_batch *batch)
{
    for (int64_t i = 0; i < batch->runs; i++) {
        batch->rows[i] = 0;
        batch->status[i] = ZD_PAUSED;
        batch->way[i] = ZD_NOT_BEGUN;
        batch->statistics[i] = (zd_statistics){0};
        batch->kinetic[i] = batch->energy_error[i] = 0;
        *zd_message_of(batch, i) = '\0';
    }
}

int zd_batch_run(const zd_batch *batch)
{
    zd_arena arena = {0};
    zd_single_run_create(&arena, batch);
    arena = (zd_arena){.base = zd_allocate(arena.used)};
    prepare(batch);
    if (!arena.base) return ZD_NO_MEMORY;
    const zd_single_run own = zd_single_run_create(&arena, batch);
    int status = ZD_DONE;
    if (zd_lanes_serve(batch)) status = zd_run_side_by_side(batch, &own);
    else
        for (int64_t i = 0; i < batch->runs && !zd_batch_is_stopped(batch); i++) zd_single_run_execute(batch, &own, i);
    zd_release(arena.base);
    return status;
}
