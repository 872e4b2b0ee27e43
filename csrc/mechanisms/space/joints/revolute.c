/* Revolute joint: the points of both bodies coincide, and an axis is common to both. */
#include "primitives.h"

const zd_space_joint_kind zd_space_revolute = {
    .card = {.name = "revolute", .summary = "Turns one body about an axis of the other.", .equations = "(3), (5)"},
    .rows = 5,
    .row = {POINT_ON_POINT, PARALLEL_AXES},
    .coordinate = {ANGLE_ABOUT_AXIS},
    .axes = 1,
    .is_inboard = 1, .freedoms = 1, .freedom = {TURNS_ABOUT(A, "angle")},
};
