/* Rod: two points keep their distance. Its one row is a length, so that its multiplier is a force. */
#include "primitives.h"

const zd_space_joint_kind zd_space_rod = {
    .card = {.name = "rod", .summary = "Keeps two points at a distance, as a massless rod with a ball at each end.", .equations = "(3), (5)"},
    .rows = 1,
    .row = {{.pick = {.quantity = ZD_SPACE_DISTANCE, .zero = ZD_SPACE_ZERO_LENGTH}}},
    .takes_length = 1,
    .tension = "tension",
};
