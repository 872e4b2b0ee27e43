/* Universal joint: the points of both bodies coincide, and an axis of the first stays perpendicular to a normal of the second. Its angles
 * are those by which a massless cross with arms along these two is turned against the first body, and the second against the cross. */
#include "primitives.h"

const zd_space_joint_kind zd_space_universal = {
    .card = {.name = "universal", .summary = "Joins two bodies by a cross, with an axis on each that are perpendicular.",
             .equations = "(3), (5)"},
    .rows = 4,
    .row = {POINT_ON_POINT, PERPENDICULAR(A, N)},
    .coordinate = {
        {"angle1", {.quantity = ZD_SPACE_ANGLE, .of_first = N, .of_second = N}},
        {"angle2", {.quantity = ZD_SPACE_ANGLE, .of_first = A, .of_second = A, .is_swapped = 1}},
    },
    .axes = 2,
    .is_inboard = 1, .freedoms = 2, .freedom = {TURNS_ABOUT(A, "angle1"), TURNS_ABOUT(N, "angle2")},
};
