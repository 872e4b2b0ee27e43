/* Planar joint: the second body's point stays in a plane of the first, whose normal, the axis, is common to both. */
#include "primitives.h"

const zd_space_joint_kind zd_space_planar = {
    .card = {.name = "planar", .summary = "Slides one body on a plane of the other, and turns it about the plane's normal.",
             .equations = "(3), (5)"},
    .rows = 3,
    .row = {POINT_IN_PLANE(A), PARALLEL_AXES},
    .coordinate = {ANGLE_ABOUT_AXIS},
    .axes = 1,
    .is_inboard = 1, .freedoms = 3,
    .freedom = {SLIDES_ALONG(N, "along normal"), SLIDES_ALONG(T, "along third"), TURNS_ABOUT(A, "angle")},
};
