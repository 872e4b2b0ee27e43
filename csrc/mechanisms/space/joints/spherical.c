/* Spherical joint: the points of both bodies coincide. */
#include "primitives.h"

const zd_space_joint_kind zd_space_spherical = {
    .card = {.name = "spherical", .summary = "Turns one body about a point of the other; a particle is held at that point.",
             .equations = "(3), (5)"},
    .rows = 3,
    .row = {POINT_ON_POINT},
    .is_inboard = 1, .freedoms = 1, .freedom = {SWINGS},
};
