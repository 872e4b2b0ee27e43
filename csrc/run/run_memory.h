/* Blocks of the memory of a run, as its state is saved. */
#pragma once

#include "phases.h"

/* A block: the phases and each phase, then those of each plan, allocated on demand and its own, of which the newest is the first. A run
 * without phases is its only plan. */
typedef struct zd_run_memory {
    const zd_run *run;
    const zd_phase *phase;
    zd_run *plan;           /* plan to which the block belongs; NULL: none */
    zd_memory *block;       /* NULL: after the last one */
} zd_run_memory;

/* The first block; the plan of the present phase becomes a copy of the run. */
zd_run_memory zd_run_memory_first(const zd_run *run);
void zd_run_memory_next(zd_run_memory *self);

/* The next phase whose plan is open; NULL: the first one. Returns NULL after the last. */
const zd_phase *zd_next_open_phase(const zd_run *run, const zd_phase *phase);
/* Memory in which the run itself is. */
zd_memory *zd_run_own_memory(const zd_run *run);

/* Saves images of all blocks; nonzero: out of memory. */
int zd_run_save_images(zd_run *run);
/* Opens the plan of a phase at the state and inputs in phase->opened. */
int zd_phase_reopen(zd_run *run, zd_phase *phase);
