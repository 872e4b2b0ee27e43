/* Torsion spring and damper about a joint. Its torque is that on the second body. */
#include "joint.h"

const zd_element_kind zd_torsion_spring = {
    .card = {"torsion_spring", "Spring with a damper about a joint.", "(2), (28)", 0, 0, 0},
    .gauges = 1,
    .gauge = {ZD_GAUGE_ANGLE}, .zero = {ZD_ZERO_ANGLE},
    .is_spring = 1,
    .effort = "torque", .sign = 1,
};
