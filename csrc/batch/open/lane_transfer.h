/* Transfer of open runs between a lane and their own memory. */
#ifndef ZD_LANE_TRANSFER_H
#define ZD_LANE_TRANSFER_H

#include "open_lanes_memory.h"

/* True if a run at the end of a step may continue in a lane. */
int zd_lane_may_enter(const zd_open_lanes *self, const zd_run *run);
/* Lane <- state of run i, whose order of elimination is chosen later. */
void zd_lane_enter(zd_open_lanes *self, int lane, int64_t i);
/* Run i <- state y of a lane at time t, after so many steps. Returns the status of the run. */
int zd_lane_put_back(zd_open_lanes *self, int lane, int64_t i, double t, double steps, const double *y);

#endif
