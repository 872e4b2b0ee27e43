/* Prismatic joint: the second body's point stays on an axis of the first, and both keep the angle between them. */
#include "joint.h"

const zd_plane_joint_kind zd_plane_prismatic = {
    .card = {.name = "prismatic", .summary = "Slides one body along an axis that turns with the other.", .equations = "(3), (5)"},
    .inboard = ZD_SLIDES,
    .rows = 2,
    .row = {{.quantity = ZD_PLANE_ACROSS, .zero = ZD_ZERO_ACROSS}, {.quantity = ZD_PLANE_ANGLE, .zero = ZD_ZERO_ANGLE}},
    .coordinate = "displacement", .quantity = ZD_PLANE_ALONG, .zero = ZD_ZERO_ALONG,
    .takes_axis = 1,
};
