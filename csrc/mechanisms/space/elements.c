/* Kinds of joints and of force elements of mechanisms in space. A new one is an entry here.
 *
 * Entries are written in primitives. A and N, T are the directions of the joint's frame: axis, normal and third. */
#include "elements.h"

#include <stddef.h>

#define A ZD_SPACE_AXIS
#define N ZD_SPACE_NORMAL
#define T ZD_SPACE_THIRD

#define POINT_ON_POINT {.pick = {.quantity = ZD_SPACE_X}}, {.pick = {.quantity = ZD_SPACE_Y}}, {.pick = {.quantity = ZD_SPACE_Z}}
/* A direction of the first body stays perpendicular to one of the second. */
#define PERPENDICULAR(first, second) {.pick = {.quantity = ZD_SPACE_COSINE, .of_first = (first), .of_second = (second)}}
#define PARALLEL_AXES PERPENDICULAR(N, A), PERPENDICULAR(T, A)
#define SAME_ORIENTATION PARALLEL_AXES, PERPENDICULAR(N, T)
/* The second's point stays in the plane through the first's that is perpendicular to one of its directions. */
#define POINT_IN_PLANE(first) {.pick = {.quantity = ZD_SPACE_ALONG, .of_first = (first)}}
#define POINT_ON_AXIS POINT_IN_PLANE(N), POINT_IN_PLANE(T)

/* Coordinates: angle of the second body about the axis, and displacement of its point along the axis. */
#define ANGLE_ABOUT_AXIS {"angle", {.quantity = ZD_SPACE_ANGLE, .of_first = N, .of_second = N}}
#define DISPLACEMENT_ALONG_AXIS {"displacement", {.quantity = ZD_SPACE_ALONG, .of_first = A, .zero = ZD_SPACE_ZERO_ALONG}}

/* Freedoms in these coordinates. */
#define TURNS_ABOUT(which, called) {ZD_SPACE_TURNS, which, called, ZD_SPACE_ZERO_NONE}
#define SLIDES_ALONG_AXIS {ZD_SPACE_SLIDES, A, "displacement", ZD_SPACE_ZERO_ALONG}
#define SLIDES_ALONG(which, called) {ZD_SPACE_SLIDES, which, called, ZD_SPACE_ZERO_NONE}
#define SWINGS {ZD_SPACE_SWINGS, A, NULL, ZD_SPACE_ZERO_NONE}
#define ADVANCES_ALONG_AXIS {ZD_SPACE_ADVANCES, A, "angle", ZD_SPACE_ZERO_ALONG}

#define ALONG(first) {.quantity = ZD_SPACE_ALONG, .of_first = (first), .zero = ZD_SPACE_ZERO_ALONG}
#define ABOUT(first) {.quantity = ZD_SPACE_ROTATION, .of_first = (first)}

static const zd_space_joint_kind joints[] = {
    /* Revolute joint: the points of both bodies coincide, and an axis is common to both. */
    {
        .card = {.name = "revolute", .summary = "Rotation about an axis of the first body.", .equations = "(3), (5)"},
        .rows = 5,
        .row = {POINT_ON_POINT, PARALLEL_AXES},
        .coordinate = {ANGLE_ABOUT_AXIS},
        .axes = 1,
        .is_inboard = 1, .freedoms = 1, .freedom = {TURNS_ABOUT(A, "angle")},
    },
    /* Prismatic joint: the second body's point stays on an axis of the first, and both keep their orientation to each other. */
    {
        .card = {.name = "prismatic", .summary = "Translation along an axis of the first body, without rotation.",
                 .equations = "(3), (5)"},
        .rows = 5,
        .row = {POINT_ON_AXIS, SAME_ORIENTATION},
        .coordinate = {DISPLACEMENT_ALONG_AXIS},
        .axes = 1,
        .is_inboard = 1, .freedoms = 1, .freedom = {SLIDES_ALONG_AXIS},
    },
    /* Weld: the points of both bodies coincide, and both keep their orientation to each other. */
    {
        .card = {.name = "weld", .summary = "Rigid connection of two bodies.", .equations = "(3), (5)"},
        .rows = 6,
        .row = {POINT_ON_POINT, SAME_ORIENTATION},
        .is_inboard = 1,
    },
    /* Cylindrical joint: the second body's point stays on an axis of the first, which is common to both. */
    {
        .card = {.name = "cylindrical", .summary = "Rotation about an axis of the first body, and translation along it.",
                 .equations = "(3), (5)"},
        .rows = 4,
        .row = {POINT_ON_AXIS, PARALLEL_AXES},
        .coordinate = {ANGLE_ABOUT_AXIS, DISPLACEMENT_ALONG_AXIS},
        .axes = 1,
        .is_inboard = 1, .freedoms = 2, .freedom = {SLIDES_ALONG_AXIS, TURNS_ABOUT(A, "angle")},
    },
    /* Screw: a cylindrical joint whose displacement follows its angle, right-handed where the length for each radian is positive. */
    {
        .card = {.name = "screw", .summary = "Rotation about an axis of the first body, with a proportional advance along it.",
                 .equations = "(3), (5)"},
        .rows = 5,
        .row = {POINT_ON_AXIS, PARALLEL_AXES,
                {.pick = {.quantity = ZD_SPACE_ALONG, .of_first = A, .zero = ZD_SPACE_ZERO_ALONG}, .advances = 1}},
        .coordinate = {ANGLE_ABOUT_AXIS, DISPLACEMENT_ALONG_AXIS},
        .axes = 1, .takes_length = 1,
        .is_inboard = 1, .freedoms = 1, .freedom = {ADVANCES_ALONG_AXIS},
    },
    /* Universal joint: the points of both bodies coincide, and an axis of the first keeps its angle to a normal of the second. Its
     * angles are those by which a massless cross with arms along these two is turned against the first body, and the second against the
     * cross. */
    {
        .card = {.name = "universal", .summary = "Universal joint: a cross with one axis on each body.",
                 .equations = "(3), (5)"},
        .rows = 4,
        .row = {POINT_ON_POINT, {.pick = {.quantity = ZD_SPACE_COSINE, .of_first = A, .of_second = N, .zero = ZD_SPACE_ZERO_ALONG}}},
        .coordinate = {
            {"angle1", {.quantity = ZD_SPACE_ANGLE, .of_first = N, .of_second = N}},
            {"angle2", {.quantity = ZD_SPACE_ANGLE, .of_first = A, .of_second = A, .is_swapped = 1}},
        },
        .axes = 2,
        .is_inboard = 1, .freedoms = 2, .freedom = {TURNS_ABOUT(A, "angle1"), TURNS_ABOUT(N, "angle2")},
    },
    /* Spherical joint: the points of both bodies coincide. */
    {
        .card = {.name = "spherical", .summary = "Rotation about a point of the first body; a particle is fixed at that point.",
                 .equations = "(3), (5)"},
        .rows = 3,
        .row = {POINT_ON_POINT},
        .is_inboard = 1, .freedoms = 1, .freedom = {SWINGS},
    },
    /* Planar joint: the second body's point stays in a plane of the first, whose normal, the axis, is common to both. */
    {
        .card = {.name = "planar", .summary = "Translation in a plane of the first body, and rotation about its normal.",
                 .equations = "(3), (5)"},
        .rows = 3,
        .row = {POINT_IN_PLANE(A), PARALLEL_AXES},
        .coordinate = {ANGLE_ABOUT_AXIS},
        .axes = 1,
        .is_inboard = 1, .freedoms = 3,
        .freedom = {SLIDES_ALONG(N, "along normal"), SLIDES_ALONG(T, "along third"), TURNS_ABOUT(A, "angle")},
    },
    /* Rod: two points keep their distance. Its one row is a length, so that its multiplier is a force. */
    {
        .card = {.name = "rod", .summary = "Constant distance of two points: a massless rod with a ball at each end.",
                 .equations = "(3), (5)"},
        .rows = 1,
        .row = {{.pick = {.quantity = ZD_SPACE_DISTANCE, .zero = ZD_SPACE_ZERO_LENGTH}}},
        .takes_length = 1,
        .tension = "tension",
    },
    /* Slot: a point of the second body stays on a line of the first. */
    {
        .card = {.name = "slot", .summary = "Point of the second body on a line of the first.",
                 .equations = "(3), (5)"},
        .rows = 2,
        .row = {POINT_ON_AXIS},
        .coordinate = {DISPLACEMENT_ALONG_AXIS},
        .axes = 1,
        .is_inboard = 1, .freedoms = 2, .freedom = {SLIDES_ALONG_AXIS, SWINGS},
    },
    /* Rolling: an ellipsoid of the second body about its point, as a sphere or, with one semiaxis zero, a disc, touches a plane of the first
     * through its point, whose normal is the axis, and what touches there has one velocity. */
    {
        .card = {
            .name = "rolling",
            .summary = "Disc, sphere or ellipsoid that rolls without slip on a plane of the first body.",
            .equations = "(3), (5)",
        },
        .rows = 3,
        .row = {
            {.pick = {.quantity = ZD_SPACE_CLEARANCE, .of_first = A}},
            {.pick = {.quantity = ZD_SPACE_SLIP, .of_first = N}, .nonholonomic = 1},
            {.pick = {.quantity = ZD_SPACE_SLIP, .of_first = T}, .nonholonomic = 1},
        },
        .rolls = 1,
    },
    /* Bearing: a revolute joint of which the first two multipliers are the components of its radial force. */
    {
        .card = {.name = "bearing", .summary = "Rotation about an axis of the first body, with the force along and across the axis.",
                 .equations = "(3), (5)"},
        .rows = 5,
        .row = {POINT_ON_AXIS, POINT_IN_PLANE(A), PARALLEL_AXES},
        .coordinate = {ANGLE_ABOUT_AXIS},
        .axes = 1,
    },
    /* Ball on a sphere of the first body: the distance of their centres, and the velocity around it. The length is its radius, negative
     * inside. */
    {
        .card = {.name = "sphere", .summary = "Ball that rolls without slip on a sphere of the first body.", .equations = "(3), (5)"},
        .rows = 3,
        .row = {
            {.pick = {.quantity = ZD_SPACE_DISTANCE, .zero = ZD_SPACE_ZERO_ALONG}},
            {.pick = {.quantity = ZD_SPACE_ORBIT, .of_first = N}, .nonholonomic = 1},
            {.pick = {.quantity = ZD_SPACE_ORBIT_ACROSS, .of_first = N}, .nonholonomic = 1},
        },
        .rolls = 1, .takes_length = 1,
    },
    /* Knife edge, as a skate or a blade: a point of the second body has no velocity along the normal of its frame, which is across the
     * blade. */
    {
        .card = {
            .name = "knife_edge",
            .summary = "No velocity of a point across a blade that turns with its body.",
            .equations = "(5)",
        },
        .rows = 1,
        .row = {{.pick = {.quantity = ZD_SPACE_GLIDE, .of_first = N, .is_own = 1}, .nonholonomic = 1}},
    },
};

enum { JOINT_COUNT = sizeof joints / sizeof joints[0] };

int zd_space_joint_kinds(void) { return JOINT_COUNT; }

const zd_space_joint_kind *zd_space_joint_kind_of(int row) { return row >= 0 && row < JOINT_COUNT ? &joints[row] : NULL; }

static const zd_space_element_kind elements[] = {
    /* Spring and damper along the line between two points: slack at its free length. Its force is positive where it pulls. */
    {
        .card = {.name = "spring", .summary = "Spring and damper between two points.", .equations = "(2), (28)"},
        .quantities = 1,
        .pick = {{.quantity = ZD_SPACE_DISTANCE, .zero = ZD_SPACE_ZERO_LENGTH}},
        .is_spring = 1,
        .measure = "force", .sign = -1,
    },
    /* Bushing: an elastic joint, with a stiffness and a damping along and about each of three directions of the first body. Its torques are
     * those of the components of the rotation vector, so that they are smooth up to half a turn, whatever its direction; dampers about the
     * directions act on the components of the relative angular velocity. */
    {
        .card = {
            .name = "bushing",
            .summary = "Elastic joint: springs and dampers along and about the axes of the first body.",
            .equations = "(2), (28)",
            .description = "In space the angles about its directions are the components of the rotation vector: the unit axis about "
                           "which the second body has rotated, as seen from the first, times the angle. The angle is counted up to half a "
                           "turn, where the torque of its stiffness changes its sign; in the plane it is counted on. Dampers about the "
                           "directions act on the components of the relative angular velocity. In space `stiffness` may be a symmetric "
                           "matrix K (6, 6), `torsion` included: with x the displacements along its directions and the rotation vector, "
                           "force and torque are minus the gradient of x^T K x / 2, so that positive definite ones restore.",
        },
        .quantities = 6,
        .pick = {ALONG(A), ALONG(N), ALONG(T), ABOUT(A), ABOUT(N), ABOUT(T)},
        .is_spring = 1,
        .axes = 3,
        .sign = 1,
    },
    /* Torsion spring and damper about the axis of a joint. Its torque is that on the second body. */
    {
        .card = {.name = "torsion_spring", .summary = "Spring and damper about the axis of a joint.",
                 .equations = "(2), (28)"},
        .quantities = 1,
        .pick = {{.quantity = ZD_SPACE_ANGLE, .of_first = N, .of_second = N}},
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
        .pick = {{.quantity = ZD_SPACE_GLIDE, .of_first = A}},
        .axes = 1,
        .measure = "force", .sign = 1,
    },
    /* Torque on the second body about an axis of the first, with its opposite on the first. */
    {
        .card = {.name = "torque", .summary = "Torque on a body, with its reaction on another.", .equations = "(2), (28)"},
        .quantities = 1,
        .pick = {{.quantity = ZD_SPACE_TURN, .of_first = A}},
        .axes = 1,
        .measure = "torque", .sign = 1,
    },
};

enum { ELEMENT_COUNT = sizeof elements / sizeof elements[0] };

int zd_space_element_kinds(void) { return ELEMENT_COUNT; }

const zd_space_element_kind *zd_space_element_kind_of(int row) { return row >= 0 && row < ELEMENT_COUNT ? &elements[row] : NULL; }
