/* Spring and damper along the line between two points: slack at its free length. Its force is positive where it pulls. */
#include "element.h"

const zd_space_element_kind zd_space_spring = {
    .card = {.name = "spring", .summary = "Spring with a damper between two points.", .equations = "(2), (28)"},
    .quantities = 1,
    .pick = {{.quantity = ZD_SPACE_DISTANCE, .zero = ZD_SPACE_ZERO_LENGTH}},
    .is_spring = 1,
    .measure = "force", .sign = -1,
};
