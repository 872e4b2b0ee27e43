/* Force at a point of the second body along an axis of the first, on which nothing acts: the ground, or the body whose frame it turns
 * with. */
#include "../joints/primitives.h"
#include "element.h"

const zd_space_element_kind zd_space_force = {
    .card = {
        .name = "force",
        .summary = "Force at a point along a direction that stays fixed, or turns with a body.",
        .equations = "(2), (28)",
    },
    .quantities = 1,
    .pick = {{.quantity = ZD_SPACE_GLIDE, .of_first = A}},
    .axes = 1,
    .measure = "force", .sign = 1,
};
