/* Slot: a point of the second body stays on a line of the first. */
#include "joint.h"

const zd_plane_joint_kind zd_plane_slot = {
    .card = {.name = "slot", .summary = "Guides a point along a line that turns with the first body.", .equations = "(3), (5)"},
    .rows = 1,
    .row = {{.quantity = ZD_PLANE_ACROSS, .zero = ZD_ZERO_ACROSS}},
    .coordinate = "displacement", .quantity = ZD_PLANE_ALONG, .zero = ZD_ZERO_ALONG,
    .takes_axis = 1,
};
