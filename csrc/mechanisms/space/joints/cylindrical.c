/* Cylindrical joint: the second body's point stays on an axis of the first, which is common to both. */
#include "primitives.h"

const zd_space_joint_kind zd_space_cylindrical = {
    .card = {.name = "cylindrical", .summary = "Turns one body about an axis of the other, and slides it along.", .equations = "(3), (5)"},
    .rows = 4,
    .row = {POINT_ON_AXIS, PARALLEL_AXES},
    .coordinate = {ANGLE_ABOUT_AXIS, DISPLACEMENT_ALONG_AXIS},
    .axes = 1,
    .is_inboard = 1, .freedoms = 2, .freedom = {SLIDES_ALONG_AXIS, TURNS_ABOUT(A, "angle")},
};
