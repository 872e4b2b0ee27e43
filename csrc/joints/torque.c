/* Torque on the second body, with its opposite on the first. */
#include "joint.h"

const zd_element_kind zd_torque = {
    .card = {"torque", "Torque on a body, and against another.", "(2), (28)", 0, 0, 0},
    .gauges = 1,
    .gauge = {ZD_GAUGE_ANGLE}, .zero = {ZD_ZERO_NONE},
    .effort = "torque", .sign = 1,
};
