/* Torsion spring and damper about the axis of a joint. Its torque is that on the second body. */
#include "../joints/primitives.h"
#include "element.h"

const zd_space_element_kind zd_space_torsion_spring = {
    .card = {.name = "torsion_spring", .summary = "Spring with a damper about the axis of a joint.", .equations = "(2), (28)"},
    .quantities = 1,
    .pick = {{.quantity = ZD_SPACE_ANGLE, .of_first = N, .of_second = N}},
    .is_spring = 1, .at_joint = 1,
    .measure = "torque", .sign = 1,
};
