/* Runs of a batch in vector lanes. */
#ifndef ZD_SIDE_BY_SIDE_H
#define ZD_SIDE_BY_SIDE_H

#include "single_run.h"

/* True if lanes can make the corrections: none, or positions and velocities in the mass metric, and those that follow. */
int zd_lanes_serve_run(const zd_run *run);
/* True if the system and the settings of the batch admit runs in lanes. */
int zd_lanes_serve(const zd_batch *batch);
/* Makes all runs: in lanes, or individually those that these cannot make. */
int zd_run_side_by_side(const zd_batch *batch, const zd_single_run *own);

#endif
