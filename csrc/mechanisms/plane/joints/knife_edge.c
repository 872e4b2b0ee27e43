/* Knife edge, as a skate or a blade: a point has no velocity across its axis. First and second are the body that it belongs to. */
#include "joint.h"

const zd_plane_joint_kind zd_plane_knife_edge = {
    .card = {
        .name = "knife_edge",
        .summary = "Lets a point of a body glide along a direction that turns with the body, and not across.",
        .equations = "(5)",
    },
    .rows = 1,
    .row = {{.quantity = ZD_PLANE_SKID, .nonholonomic = 1}},
    .takes_axis = 1,
};
