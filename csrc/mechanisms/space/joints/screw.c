/* Screw: a cylindrical joint whose displacement follows its angle, right-handed where the length for each radian is positive. */
#include "primitives.h"

const zd_space_joint_kind zd_space_screw = {
    .card = {.name = "screw", .summary = "Turns one body about an axis of the other, along which it advances.", .equations = "(3), (5)"},
    .rows = 5,
    .row = {POINT_ON_AXIS, PARALLEL_AXES,
            {.pick = {.quantity = ZD_SPACE_ALONG, .of_first = A, .zero = ZD_SPACE_ZERO_ALONG}, .advances = 1}},
    .coordinate = {ANGLE_ABOUT_AXIS, DISPLACEMENT_ALONG_AXIS},
    .axes = 1, .takes_length = 1,
    .is_inboard = 1, .freedoms = 1, .freedom = {ADVANCES_ALONG_AXIS},
};
