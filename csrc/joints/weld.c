/* Weld: the points of both bodies coincide, and both keep the angle between them. */
#include "joint.h"

const zd_joint_kind zd_weld = {
    .card = {"weld", "Fixes one body to the other.", "(3), (5)", 0, 0, 0},
    .carrier = ZD_FIXED,
    .rows = 3,
    .row = {{.gauge = ZD_GAUGE_X}, {.gauge = ZD_GAUGE_Y}, {.gauge = ZD_GAUGE_ANGLE, .zero = ZD_ZERO_ANGLE}},
};
