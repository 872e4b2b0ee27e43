/* Bushing: an elastic joint, with a stiffness and a damping along and about each of three directions of the first body. Its torques are
 * those of the components of the rotation vector, so that they are smooth up to half a turn, whatever its direction; dampers about the
 * directions act on the components of the relative angular velocity. */
#include "../joints/primitives.h"
#include "element.h"

#define ALONG(first) {.quantity = ZD_SPACE_ALONG, .of_first = (first), .zero = ZD_SPACE_ZERO_ALONG}
#define ABOUT(first) {.quantity = ZD_SPACE_ROTATION, .of_first = (first)}

const zd_space_element_kind zd_space_bushing = {
    .card = {
        .name = "bushing",
        .summary = "Joins two bodies softly, by springs and dampers along and about the axes of the first.",
        .equations = "(2), (28)",
        .description = "In space the angles about its directions are the components of the rotation vector: the unit axis about which the "
                       "second body has rotated, as seen from the first, times the angle. The angle is counted up to half a turn, where "
                       "the torque of its stiffness changes its sign; in the plane it is counted on. Dampers about the directions act on "
                       "the components of the relative angular velocity.",
    },
    .quantities = 6,
    .pick = {ALONG(A), ALONG(N), ALONG(T), ABOUT(A), ABOUT(N), ABOUT(T)},
    .is_spring = 1,
    .axes = 3,
    .sign = 1,
};
