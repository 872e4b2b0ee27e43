/* Rod: two points keep their distance. Its one row is a length, so that its multiplier is a force. */
#include "joint.h"

const zd_plane_joint_kind zd_plane_rod = {
    .card = {
        .name = "rod",
        .summary = "Keeps two points at a distance, as a massless rod with a hinge at each end.",
        .equations = "(3), (5)",
    },
    .rows = 1,
    .row = {{.quantity = ZD_PLANE_DISTANCE, .zero = ZD_ZERO_LENGTH}},
    .takes_length = 1,
    .tension = "tension",
};
