/* Points and directions that move with bodies, and the marker quantities of contacts. */
#pragma once

#include "../../linalg/small.h"
#include "bodies.h"

typedef struct zd_moving {
    zd_vector3 value, rate, second;     /* the second rate where no velocity changes */
} zd_moving;

ZD_INLINE zd_vector3 zd_direction_of(const zd_space_pose *pose, const double *direction)
{
    return zd_rotated3(&pose->turned, zd_vector3_of(direction));
}

ZD_INLINE zd_moving zd_turning(const zd_space_pose *pose, const zd_space_twist *twist, const double *direction)
{
    const zd_vector3 value = zd_direction_of(pose, direction), rate = zd_cross3(twist->spin, value);
    return (zd_moving){value, rate, zd_cross3(twist->spin, rate)};
}

ZD_INLINE zd_moving zd_point_moving(const zd_space_pose *pose, const zd_space_twist *twist, const double *point)
{
    const zd_moving arm = zd_turning(pose, twist, point);
    return (zd_moving){zd_plus3(pose->at, arm.value), zd_plus3(twist->speed, arm.rate), arm.second};
}

ZD_INLINE zd_moving zd_difference(zd_moving a, zd_moving b)
{
    return (zd_moving){zd_minus3(a.value, b.value), zd_minus3(a.rate, b.rate), zd_minus3(a.second, b.second)};
}

/* Value and wrenches of a marker quantity of a contact; `apart`: from P to Q. */
void zd_read_contact(const zd_space_quantity *quantity, const zd_space_pose *pose, zd_vector3 apart, zd_space_reading *to);
/* Derivative of its rate where no velocity changes. */
double zd_bias_of_contact(const zd_space_quantity *quantity, const zd_space_pose *pose, const zd_space_twist *twist, zd_moving a, zd_moving o,
                          zd_moving apart);
