/* Bushing: an elastic joint, with a stiffness and a damping along and about each of three directions of the first body. The angle about a
 * direction is that by which the next one has turned. */
#include "../joints/primitives.h"
#include "element.h"

#define ALONG(first) {.quantity = ZD_SPACE_ALONG, .of_first = (first), .zero = ZD_SPACE_ZERO_ALONG}
#define TURN_OF(direction) {.quantity = ZD_SPACE_ANGLE, .of_first = (direction), .of_second = (direction)}

const zd_space_element_kind zd_space_bushing = {
    .card = {
        .name = "bushing",
        .summary = "Joins two bodies softly, by springs and dampers along and about the axes of the first.",
        .equations = "(2), (28)",
        .description = "In space the angle about a direction is that by which the next one has turned, as seen along it. So a turn about "
                       "one direction is that angle, and small ones about several are those of a linear model; none may come near half a "
                       "turn.",
    },
    .quantities = 6,
    .pick = {ALONG(A), ALONG(N), ALONG(T), TURN_OF(N), TURN_OF(T), TURN_OF(A)},
    .is_spring = 1,
    .axes = 3,
    .sign = 1,
};
