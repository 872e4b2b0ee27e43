/* Bushing: an elastic joint, with a stiffness and a damping for each of its three motions. */
#include "element.h"

const zd_plane_element_kind zd_plane_bushing = {
    .card = {
        .name = "bushing",
        .summary = "Joins two bodies softly, by springs and dampers along and about the axes of the first.",
        .equations = "(2), (28)",
        .description = "It is slack as drawn.",
    },
    .quantities = 3,
    .quantity = {ZD_PLANE_ALONG, ZD_PLANE_ACROSS, ZD_PLANE_ANGLE},
    .zero = {ZD_ZERO_ALONG, ZD_ZERO_ACROSS, ZD_ZERO_ANGLE},
    .is_spring = 1,
    .sign = 1,
};
