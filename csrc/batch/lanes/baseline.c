#include "../../include/zerodrift/units.h"
#if (ZD_SETS) & ZD_SET_BASELINE_2
#define ZD_UNIT 0
#define ZD_LANES 2
#include "advance.h"

const zd_lane_functions zd_lanes_baseline = {0, 2, ZD_NAMED(choose), ZD_NAMED(renew), ZD_NAMED(advance), ZD_NAMED(move_within),
                                           ZD_NAMED(substep), ZD_NAMED(cut), ZD_NAMED(check)};
#else
#include "numbers.h"

const zd_lane_functions zd_lanes_baseline = {0, 0, NULL, NULL, NULL, NULL, NULL, NULL, NULL};
#endif
