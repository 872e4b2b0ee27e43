/* Wheel that rolls on a line: its centre, the second body's point, stays one radius above the line, and moves along it by the radius times
 * the angle it turns back. Both are holonomic in the plane, and the force that they exert acts at the contact. */
#include "joint.h"

const zd_plane_joint_kind zd_plane_rolling = {
    .card = {.name = "rolling", .summary = "Rolls a wheel along a line of the first body without slip.", .equations = "(3), (5)"},
    .rows = 2,
    .row = {
        {.quantity = ZD_PLANE_ACROSS, .zero = ZD_ZERO_LENGTH},
        {.quantity = ZD_PLANE_ALONG, .zero = ZD_ZERO_ALONG, .rolls = 1},
    },
    .coordinate = "displacement", .quantity = ZD_PLANE_ALONG, .zero = ZD_ZERO_ALONG,
    .takes_axis = 1, .takes_length = 1,
    .at_contact = 1,
};
