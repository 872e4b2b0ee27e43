/* Force at a point of the second body along an axis of the first, on which nothing acts: the ground,
 * or the body whose frame it turns with. */
#include "element.h"

const zd_plane_element_kind zd_plane_force = {
    .card = {
        .name = "force",
        .summary = "Force at a point along a direction that stays fixed, or turns with a body.",
        .equations = "(2), (28)",
    },
    .quantities = 1,
    .quantity = {ZD_PLANE_GLIDE}, .zero = {ZD_ZERO_NONE},
    .axes = 1,
    .measure = "force", .sign = 1,
};
