/* Many runs in one call: each begins at its entry of the arrays and ends independently of the others. */
#include "batch.h"

static void prepare(const zd_batch *batch)
{
    for (int64_t i = 0; i < batch->runs; i++) {
        batch->samples[i] = 0;
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
    prepare(batch);
    if (!zd_arena_allocate(&arena)) return ZD_NO_MEMORY;
    const zd_single_run own = zd_single_run_create(&arena, batch);
    int status = ZD_DONE;
    if (zd_lanes_serve(batch)) status = zd_run_side_by_side(batch, &own);
    else
        for (int64_t i = 0; i < batch->runs && !zd_batch_is_stopped(batch); i++) zd_single_run_execute(batch, &own, i);
    zd_release(arena.base);
    return status;
}

/* Constants and starts of many systems, from their parameters. */

static int64_t count_parameters(const zd_kind *kind)
{
    int64_t count = 0;
    for (int i = 0; i < kind->parameters; i++) count += kind->parameter[i].size;
    return count;
}

int64_t zd_batch_of_kind(const zd_kind *kind, int64_t runs, const double *parameters, double *constants, double *p0, double *v0,
                         const char **reason)
{
    const int64_t count = count_parameters(kind);
    *reason = NULL;
    for (int64_t i = 0; i < runs; i++) {
        *reason = kind->prepare(parameters + i * count, constants + i * kind->constants);
        if (*reason) return i;
        kind->start(parameters + i * count, p0 + i * kind->system.nq, v0 + i * kind->system.nv);
    }
    return runs;
}

void zd_batch_derive(void (*derive)(double *data), int64_t runs, int64_t doubles, double *data)
{
    for (int64_t i = 0; i < runs; i++) derive(data + i * doubles);
}
