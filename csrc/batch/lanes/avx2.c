#include "../../include/zerodrift/units.h"
#if (ZD_SETS) & ZD_SET_AVX2_4
#define ZD_UNIT 1
#define ZD_LANES 4
#include "advance.h"

const zd_lane_functions zd_lanes_avx2 = {1, 4, ZD_NAMED(choose), ZD_NAMED(renew), ZD_NAMED(advance), ZD_NAMED(move_within),
                                           ZD_NAMED(substep), ZD_NAMED(cut), ZD_NAMED(check)};
#else
#include "numbers.h"

const zd_lane_functions zd_lanes_avx2 = {1, 0, NULL, NULL, NULL, NULL, NULL, NULL, NULL};
#endif
