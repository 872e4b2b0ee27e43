/* Torsion spring and damper about a joint. Its torque is that on the second body. */
#include "element.h"

const zd_plane_element_kind zd_plane_torsion_spring = {
    .card = {.name = "torsion_spring", .summary = "Spring with a damper about the axis of a joint.", .equations = "(2), (28)"},
    .quantities = 1,
    .quantity = {ZD_PLANE_ANGLE}, .zero = {ZD_ZERO_ANGLE},
    .is_spring = 1, .at_joint = 1,
    .measure = "torque", .sign = 1,
};
