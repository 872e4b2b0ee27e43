/* An image of a plan is that of its opening, which another run repeats from the same state and inputs. */
#include "run_memory.h"

#include "../linalg/small.h"

static zd_memory *first_of(const zd_run *plan) { return plan->motion.store.last ? plan->motion.store.last : plan->memory; }

zd_run_memory zd_run_memory_first(const zd_run *run)
{
    zd_run_memory it = {.run = run};
    if (run->phases) {
        *run->phases->present->plan = *run;
        it.block = run->phases->store.last;
        return it;
    }
    it.plan = (zd_run *)(void *)run->memory->base;
    it.block = first_of(it.plan);
    return it;
}

const zd_phase *zd_next_open_phase(const zd_run *run, const zd_phase *phase)
{
    if (!run->phases) return NULL;
    do phase = phase ? phase->next : run->phases->first;
    while (phase && !phase->is_open);
    return phase;
}

void zd_run_memory_next(zd_run_memory *it)
{
    if (it->block->previous) it->block = it->block->previous;
    else if (it->plan && it->block != it->plan->memory) it->block = it->plan->memory;
    else {
        it->phase = zd_next_open_phase(it->run, it->phase);
        it->plan = it->phase ? it->phase->plan : NULL;
        it->block = it->plan ? first_of(it->plan) : NULL;
    }
}

zd_memory *zd_run_own_memory(const zd_run *run)
{
    return run->phases && run->phases->present != run->phases->first ? run->phases->first->plan->memory : run->memory;
}

int zd_run_save_images(zd_run *run)
{
    int status = ZD_DONE;
    if (run->phases) run->phases->has_images = 1;
    zd_run_memory it = zd_run_memory_first(run);
    const zd_phase *phase = NULL;
    while ((phase = zd_next_open_phase(run, phase))) phase->plan->start = run->start;
    for (; it.block && !status; zd_run_memory_next(&it))
        if (zd_memory_save(it.block)) status = ZD_NO_MEMORY;
    return status;
}

int zd_phase_reopen(zd_run *run, zd_phase *phase)
{
    zd_phases *phases = run->phases;
    const zd_system *full = phases->full;
    const double *p = phase->opened + 1, *v = p + full->nq;
    zd_run *before = phases->present->plan;
    phases->at.t = *phase->opened;
    zd_copy_all(full->nq, p, phases->at.p);
    zd_copy_all(full->nv, v, phases->at.v);
    zd_inputs_restore(phases->settings.inputs, v + full->nv);
    *before = *run;
    return zd_phase_open(run, phase, before);
}
