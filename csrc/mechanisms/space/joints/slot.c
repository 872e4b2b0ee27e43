/* Slot: a point of the second body stays on a line of the first. */
#include "primitives.h"

const zd_space_joint_kind zd_space_slot = {
    .card = {.name = "slot", .summary = "Guides a point along a line that turns with the first body.", .equations = "(3), (5)"},
    .rows = 2,
    .row = {POINT_ON_AXIS},
    .coordinate = {DISPLACEMENT_ALONG_AXIS},
    .axes = 1,
    .is_inboard = 1, .freedoms = 2, .freedom = {SLIDES_ALONG_AXIS, SWINGS},
};
