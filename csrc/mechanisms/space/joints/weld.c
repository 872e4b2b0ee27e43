/* Weld: the points of both bodies coincide, and both keep their orientation to each other. */
#include "primitives.h"

const zd_space_joint_kind zd_space_weld = {
    .card = {.name = "weld", .summary = "Fixes one body to the other.", .equations = "(3), (5)"},
    .rows = 6,
    .row = {POINT_ON_POINT, SAME_ORIENTATION},
    .is_inboard = 1,
};
