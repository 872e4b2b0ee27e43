/* Torsion spring and damper about a joint. Its torque is that on the second body. */
#include "joint.h"

const zd_plane_element_kind zd_plane_torsion_spring = {
    .card = {.name = "torsion_spring", .summary = "Spring with a damper about a joint.", .equations = "(2), (28)"},
    .gauges = 1,
    .gauge = {ZD_GAUGE_ANGLE}, .zero = {ZD_ZERO_ANGLE},
    .is_spring = 1,
    .effort = "torque", .sign = 1,
};
