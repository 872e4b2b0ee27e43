/* Torque on the second body, with its opposite on the first. */
#include "element.h"

const zd_plane_element_kind zd_plane_torque = {
    .card = {.name = "torque", .summary = "Torque on a body, and against another.", .equations = "(2), (28)"},
    .quantities = 1,
    .quantity = {ZD_PLANE_ANGLE}, .zero = {ZD_ZERO_NONE},
    .measure = "torque", .sign = 1,
};
