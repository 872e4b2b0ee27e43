/* Rolling: an ellipsoid of the second body about its point, as a sphere or, with one semiaxis zero, a disc, touches a plane of the first
 * through its point, whose normal is the axis, and what touches there has one velocity. */
#include "primitives.h"

const zd_space_joint_kind zd_space_rolling = {
    .card = {
        .name = "rolling",
        .summary = "Rolls a disc, a sphere or an ellipsoid on a plane of the first body without slip.",
        .equations = "(3), (5)",
    },
    .rows = 3,
    .row = {
        {.pick = {.quantity = ZD_SPACE_CLEARANCE, .of_first = A}},
        {.pick = {.quantity = ZD_SPACE_SLIP, .of_first = N}, .nonholonomic = 1},
        {.pick = {.quantity = ZD_SPACE_SLIP, .of_first = T}, .nonholonomic = 1},
    },
    .rolls = 1,
};
