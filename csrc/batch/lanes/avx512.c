#include "../../include/zerodrift/units.h"
#if (ZD_SETS) & ZD_SET_AVX512_8
#define ZD_UNIT 2
#define ZD_LANES 8
#include "advance.h"

const zd_lane_functions zd_lanes_avx512 = ZD_LANE_FUNCTIONS;
#else
#include "numbers.h"

const zd_lane_functions zd_lanes_avx512 = {0};
#endif
