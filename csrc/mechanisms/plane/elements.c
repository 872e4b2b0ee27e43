/* Kinds of joints and of force elements of planar mechanisms. A new one is an entry here. */
#include "elements.h"

#include <stddef.h>

static const zd_plane_joint_kind joints[] = {
    /* Revolute joint: the points of both bodies coincide. */
    {
        .card = {
            .name = "revolute",
            .summary = "Rotation about a point of the first body; a particle is fixed at that point.",
            .equations = "(3), (5)",
        },
        .inboard = ZD_TURNS,
        .rows = 2,
        .row = {{.quantity = ZD_PLANE_X}, {.quantity = ZD_PLANE_Y}},
        .coordinate = "angle", .quantity = ZD_PLANE_ANGLE, .zero = ZD_ZERO_ANGLE,
    },
    /* Prismatic joint: the second body's point stays on an axis of the first, and both keep the angle between them. */
    {
        .card = {.name = "prismatic", .summary = "Translation along an axis of the first body, without rotation.",
                 .equations = "(3), (5)"},
        .inboard = ZD_SLIDES,
        .rows = 2,
        .row = {{.quantity = ZD_PLANE_ACROSS, .zero = ZD_ZERO_ACROSS}, {.quantity = ZD_PLANE_ANGLE, .zero = ZD_ZERO_ANGLE}},
        .coordinate = "displacement", .quantity = ZD_PLANE_ALONG, .zero = ZD_ZERO_ALONG,
        .takes_axis = 1,
    },
    /* Weld: the points of both bodies coincide, and both keep the angle between them. */
    {
        .card = {.name = "weld", .summary = "Rigid connection of two bodies.", .equations = "(3), (5)"},
        .inboard = ZD_FIXED,
        .rows = 3,
        .row = {{.quantity = ZD_PLANE_X}, {.quantity = ZD_PLANE_Y}, {.quantity = ZD_PLANE_ANGLE, .zero = ZD_ZERO_ANGLE}},
    },
    /* Rod: two points keep their distance. Its one row is a length, so that its multiplier is a force. */
    {
        .card = {
            .name = "rod",
            .summary = "Constant distance of two points: a massless rod with a hinge at each end.",
            .equations = "(3), (5)",
        },
        .rows = 1,
        .row = {{.quantity = ZD_PLANE_DISTANCE, .zero = ZD_ZERO_LENGTH}},
        .takes_length = 1,
        .tension = "tension",
    },
    /* Slot: a point of the second body stays on a line of the first. */
    {
        .card = {.name = "slot", .summary = "Point of the second body on a line of the first.",
                 .equations = "(3), (5)"},
        .rows = 1,
        .row = {{.quantity = ZD_PLANE_ACROSS, .zero = ZD_ZERO_ACROSS}},
        .coordinate = "displacement", .quantity = ZD_PLANE_ALONG, .zero = ZD_ZERO_ALONG,
        .takes_axis = 1,
    },
    /* Wheel that rolls on a line: its centre, the second body's point, stays one radius above the line, and moves along it by the radius
     * times the angle it turns back. Both are holonomic in the plane, and the force that they exert acts at the contact. */
    {
        .card = {.name = "rolling", .summary = "Wheel that rolls without slip along a line of the first body.",
                 .equations = "(3), (5)"},
        .rows = 2,
        .row = {
            {.quantity = ZD_PLANE_ACROSS, .zero = ZD_ZERO_LENGTH},
            {.quantity = ZD_PLANE_ALONG, .zero = ZD_ZERO_ALONG, .rolls = 1},
        },
        .coordinate = "displacement", .quantity = ZD_PLANE_ALONG, .zero = ZD_ZERO_ALONG,
        .takes_axis = 1, .takes_length = 1,
        .at_contact = 1,
    },
    /* Round body on a circle of the first body: the distance of their centres, and the velocity around it. The length is negative inside. */
    {
        .card = {.name = "circle", .summary = "Round body that rolls without slip on a circle of the first body.",
                 .equations = "(3), (5)"},
        .rows = 2,
        .row = {
            {.quantity = ZD_PLANE_DISTANCE, .zero = ZD_ZERO_ALONG},
            {.quantity = ZD_PLANE_ORBIT, .rolls = 1, .nonholonomic = 1},
        },
        .takes_length = 1,
        .at_contact = 1,
    },
    /* Knife edge, as a skate or a blade: a point has no velocity across its axis. First and second are the body that it belongs to. */
    {
        .card = {
            .name = "knife_edge",
            .summary = "No velocity of a point across a direction that turns with its body.",
            .equations = "(5)",
        },
        .rows = 1,
        .row = {{.quantity = ZD_PLANE_SKID, .nonholonomic = 1}},
        .takes_axis = 1,
    },
};

enum { JOINT_COUNT = sizeof joints / sizeof joints[0] };

int zd_plane_joint_kinds(void) { return JOINT_COUNT; }

const zd_plane_joint_kind *zd_plane_joint_kind_of(int row) { return row >= 0 && row < JOINT_COUNT ? &joints[row] : NULL; }

static const zd_plane_element_kind elements[] = {
    /* Spring and damper along the line between two points: slack at its free length. Its force is positive where it pulls. */
    {
        .card = {.name = "spring", .summary = "Spring and damper between two points.", .equations = "(2), (28)"},
        .quantities = 1,
        .quantity = {ZD_PLANE_DISTANCE}, .zero = {ZD_ZERO_LENGTH},
        .is_spring = 1,
        .measure = "force", .sign = -1,
    },
    /* Bushing: an elastic joint, with a stiffness and a damping for each of its three motions. */
    {
        .card = {
            .name = "bushing",
            .summary = "Elastic joint: springs and dampers along and about the axes of the first body.",
            .equations = "(2), (28)",
            .description = "It is slack as drawn.",
        },
        .quantities = 3,
        .quantity = {ZD_PLANE_ALONG, ZD_PLANE_ACROSS, ZD_PLANE_ANGLE},
        .zero = {ZD_ZERO_ALONG, ZD_ZERO_ACROSS, ZD_ZERO_ANGLE},
        .is_spring = 1,
        .sign = 1,
    },
    /* Torsion spring and damper about a joint. Its torque is that on the second body. */
    {
        .card = {.name = "torsion_spring", .summary = "Spring and damper about the axis of a joint.",
                 .equations = "(2), (28)"},
        .quantities = 1,
        .quantity = {ZD_PLANE_ANGLE}, .zero = {ZD_ZERO_ANGLE},
        .is_spring = 1, .at_joint = 1,
        .measure = "torque", .sign = 1,
    },
    /* Force at a point of the second body along an axis of the first, on which nothing acts: the ground, or the body whose frame it turns
     * with. */
    {
        .card = {
            .name = "force",
            .summary = "Force at a point, along a direction that is fixed or turns with a body.",
            .equations = "(2), (28)",
        },
        .quantities = 1,
        .quantity = {ZD_PLANE_GLIDE}, .zero = {ZD_ZERO_NONE},
        .axes = 1,
        .measure = "force", .sign = 1,
    },
    /* Torque on the second body, with its opposite on the first. */
    {
        .card = {.name = "torque", .summary = "Torque on a body, with its reaction on another.", .equations = "(2), (28)"},
        .quantities = 1,
        .quantity = {ZD_PLANE_ANGLE}, .zero = {ZD_ZERO_NONE},
        .measure = "torque", .sign = 1,
    },
};

enum { ELEMENT_COUNT = sizeof elements / sizeof elements[0] };

int zd_plane_element_kinds(void) { return ELEMENT_COUNT; }

const zd_plane_element_kind *zd_plane_element_kind_of(int row) { return row >= 0 && row < ELEMENT_COUNT ? &elements[row] : NULL; }
