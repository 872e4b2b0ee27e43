#include "../../include/zerodrift/units.h"
#if (ZD_SETS) & ZD_SET_AVX512_8
#define ZD_UNIT 2
#define ZD_LANES 8
#include "advance.h"

const zd_lane_functions zd_lanes_avx512 = {2, 8, ZD_NAMED(choose), ZD_NAMED(renew), ZD_NAMED(advance), ZD_NAMED(move_within),
                                           ZD_NAMED(substep), ZD_NAMED(cut), ZD_NAMED(check)};
#else
#include "numbers.h"

const zd_lane_functions zd_lanes_avx512 = {2, 0, NULL, NULL, NULL, NULL, NULL, NULL, NULL};
#endif
