/* Weld: the points of both bodies coincide, and both keep the angle between them. */
#include "joint.h"

const zd_plane_joint_kind zd_plane_weld = {
    .card = {.name = "weld", .summary = "Fixes one body to the other.", .equations = "(3), (5)"},
    .carrier = ZD_FIXED,
    .rows = 3,
    .row = {{.gauge = ZD_GAUGE_X}, {.gauge = ZD_GAUGE_Y}, {.gauge = ZD_GAUGE_ANGLE, .zero = ZD_ZERO_ANGLE}},
};
