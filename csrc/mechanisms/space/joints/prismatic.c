/* Prismatic joint: the second body's point stays on an axis of the first, and both keep their orientation to each other. */
#include "primitives.h"

const zd_space_joint_kind zd_space_prismatic = {
    .card = {.name = "prismatic", .summary = "Slides one body along an axis that turns with the other.", .equations = "(3), (5)"},
    .rows = 5,
    .row = {POINT_ON_AXIS, SAME_ORIENTATION},
    .coordinate = {DISPLACEMENT_ALONG_AXIS},
    .axes = 1,
    .is_inboard = 1, .freedoms = 1, .freedom = {SLIDES_ALONG_AXIS},
};
