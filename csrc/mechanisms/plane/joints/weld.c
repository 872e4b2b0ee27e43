/* Weld: the points of both bodies coincide, and both keep the angle between them. */
#include "joint.h"

const zd_plane_joint_kind zd_plane_weld = {
    .card = {.name = "weld", .summary = "Fixes one body to the other.", .equations = "(3), (5)"},
    .inboard = ZD_FIXED,
    .rows = 3,
    .row = {{.quantity = ZD_PLANE_X}, {.quantity = ZD_PLANE_Y}, {.quantity = ZD_PLANE_ANGLE, .zero = ZD_ZERO_ANGLE}},
};
