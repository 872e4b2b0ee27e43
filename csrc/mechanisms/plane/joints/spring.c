/* Spring and damper along the line between two points: slack at its free length. Its force is positive where it pulls. */
#include "joint.h"

const zd_plane_element_kind zd_plane_spring = {
    .card = {.name = "spring", .summary = "Spring with a damper between two points.", .equations = "(2), (28)"},
    .gauges = 1,
    .gauge = {ZD_GAUGE_DISTANCE}, .zero = {ZD_ZERO_LENGTH},
    .is_spring = 1,
    .effort = "force", .sign = -1,
};
