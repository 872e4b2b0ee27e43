/* Revolute joint: the points of both bodies coincide. */
#include "joint.h"

const zd_joint_kind zd_revolute = {
    .card = {"revolute", "Turns one body about a point of the other; a particle is held at that point.", "(3), (5)", 0, 0, 0},
    .carrier = ZD_TURNS,
    .rows = 2,
    .row = {{.gauge = ZD_GAUGE_X}, {.gauge = ZD_GAUGE_Y}},
    .coordinate = "angle", .gauge = ZD_GAUGE_ANGLE, .zero = ZD_ZERO_ANGLE,
};
