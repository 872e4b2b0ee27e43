/* Revolute joint: the points of both bodies coincide. */
#include "joint.h"

const zd_plane_joint_kind zd_plane_revolute = {
    .card = {
        .name = "revolute",
        .summary = "Turns one body about a point of the other; a particle is held at that point.",
        .equations = "(3), (5)",
    },
    .carrier = ZD_TURNS,
    .rows = 2,
    .row = {{.gauge = ZD_GAUGE_X}, {.gauge = ZD_GAUGE_Y}},
    .coordinate = "angle", .gauge = ZD_GAUGE_ANGLE, .zero = ZD_ZERO_ANGLE,
};
