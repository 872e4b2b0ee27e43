/* Runs of a batch in vector lanes. */
#ifndef ZD_SIDE_BY_SIDE_H
#define ZD_SIDE_BY_SIDE_H

#include "single_run.h"

/* Whether runs of this batch can be made so, as far as its system and settings tell. */
int zd_lanes_serve(const zd_batch *batch);
/* All runs: in lanes, and those by themselves that these cannot make. */
int zd_run_side_by_side(const zd_batch *batch, const zd_single_run *own);

#endif
