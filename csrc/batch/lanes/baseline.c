#include "../../include/zerodrift/units.h"
#if (ZD_SETS) & ZD_SET_BASELINE_2
#define ZD_UNIT 0
#define ZD_LANES 2
#include "advance.h"

const zd_lane_functions zd_lanes_baseline = ZD_LANE_FUNCTIONS;
#else
#include "numbers.h"

const zd_lane_functions zd_lanes_baseline = {0};
#endif
