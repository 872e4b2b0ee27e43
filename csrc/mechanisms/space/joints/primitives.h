/* The primitives that tables of joints are written in. A and N, T are the directions of the joint's frame: axis, normal and third. */
#ifndef ZD_SPACE_JOINTS_PRIMITIVES_H
#define ZD_SPACE_JOINTS_PRIMITIVES_H

#include <stddef.h>

#include "joint.h"

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

#endif
