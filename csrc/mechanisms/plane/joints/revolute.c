/* Revolute joint: the points of both bodies coincide. */
#include "joint.h"

const zd_plane_joint_kind zd_plane_revolute = {
    .card = {
        .name = "revolute",
        .summary = "Turns one body about a point of the other; a particle is held at that point.",
        .equations = "(3), (5)",
    },
    .inboard = ZD_TURNS,
    .rows = 2,
    .row = {{.quantity = ZD_PLANE_X}, {.quantity = ZD_PLANE_Y}},
    .coordinate = "angle", .quantity = ZD_PLANE_ANGLE, .zero = ZD_ZERO_ANGLE,
};
