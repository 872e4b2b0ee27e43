/* Bushing: an elastic joint, with a stiffness and a damping for each of its three motions. */
#include "joint.h"

const zd_plane_element_kind zd_plane_bushing = {
    .card = {
        .name = "bushing",
        .summary = "Springs with dampers along, across and about an axis of the first body.",
        .equations = "(2), (28)",
    },
    .quantities = 3,
    .quantity = {ZD_PLANE_ALONG, ZD_PLANE_ACROSS, ZD_PLANE_ANGLE},
    .zero = {ZD_ZERO_ALONG, ZD_ZERO_ACROSS, ZD_ZERO_ANGLE},
    .is_spring = 1,
    .sign = 1,
};
