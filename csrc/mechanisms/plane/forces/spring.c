/* Spring and damper along the line between two points: slack at its free length. Its force is positive where it pulls. */
#include "element.h"

const zd_plane_element_kind zd_plane_spring = {
    .card = {.name = "spring", .summary = "Spring with a damper between two points.", .equations = "(2), (28)"},
    .quantities = 1,
    .quantity = {ZD_PLANE_DISTANCE}, .zero = {ZD_ZERO_LENGTH},
    .is_spring = 1,
    .measure = "force", .sign = -1,
};
