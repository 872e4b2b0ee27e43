#include "../../include/zerodrift/units.h"
#if (ZD_SETS) & ZD_SET_AVX2_4
#define ZD_UNIT 1
#define ZD_LANES 4
#include "advance.h"

const zd_lane_functions zd_lanes_avx2 = ZD_LANE_FUNCTIONS;
#else
#include "numbers.h"

const zd_lane_functions zd_lanes_avx2 = {0};
#endif
