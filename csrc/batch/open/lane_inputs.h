/* Inputs of open runs in lanes. */
#ifndef ZD_LANE_INPUTS_H
#define ZD_LANE_INPUTS_H

#include "open_lanes_memory.h"

zd_lane_inputs zd_lane_inputs_create(zd_arena *arena, const zd_open_runs *runs, int64_t first, int64_t count);
/* True if run i has the places and functions of the first one. */
int zd_lane_inputs_fit(const zd_open_lanes *self, int64_t i);
/* Takes over the inputs of run i, which writes new ones first; returns true if it had new ones. */
int zd_lane_inputs_enter(zd_open_lanes *self, int64_t i);
/* Gives run i the inputs of its lane; has_moved: the run is to be at another step than before. */
void zd_lane_inputs_put_back(zd_open_lanes *self, int64_t i, int has_moved);
/* Reads the inputs of run i, in a lane of the present group: 1 if they are new, 0 if not, -1 if they are refused and those before stay. */
int zd_lane_inputs_read(zd_open_lanes *self, int lane, int64_t i);

#endif
