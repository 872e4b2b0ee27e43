/* Torque on the second body about an axis of the first, with its opposite on the first. */
#include "../joints/primitives.h"
#include "element.h"

const zd_space_element_kind zd_space_torque = {
    .card = {.name = "torque", .summary = "Torque on a body, and against another.", .equations = "(2), (28)"},
    .quantities = 1,
    .pick = {{.quantity = ZD_SPACE_TURN, .of_first = A}},
    .axes = 1,
    .measure = "torque", .sign = 1,
};
