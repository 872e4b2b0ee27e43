/* Knife edge, as a skate or a blade: a point of the second body has no velocity along the normal of its frame, which is across the blade. */
#include "primitives.h"

const zd_space_joint_kind zd_space_knife_edge = {
    .card = {
        .name = "knife_edge",
        .summary = "Lets a point of a body glide along a blade that turns with the body, and not across.",
        .equations = "(5)",
    },
    .rows = 1,
    .row = {{.pick = {.quantity = ZD_SPACE_GLIDE, .of_first = N, .is_own = 1}, .nonholonomic = 1}},
};
