/* Vectors of space, and rotations. */
#pragma once

#include "../../linalg/small.h"

typedef struct zd_vector3 {
    double x, y, z;
} zd_vector3;

typedef struct zd_rotation {
    zd_vector3 x, y, z;     /* a body's axes, in the drawing's */
} zd_rotation;

/* Force on a body, and torque about its mass centre, in global axes. */
typedef struct zd_space_wrench {
    zd_vector3 force, torque;
} zd_space_wrench;

ZD_INLINE zd_vector3 zd_vector3_of(const double *a) { return (zd_vector3){a[0], a[1], a[2]}; }
ZD_INLINE zd_vector3 zd_plus3(zd_vector3 a, zd_vector3 b) { return (zd_vector3){a.x + b.x, a.y + b.y, a.z + b.z}; }
ZD_INLINE zd_vector3 zd_minus3(zd_vector3 a, zd_vector3 b) { return (zd_vector3){a.x - b.x, a.y - b.y, a.z - b.z}; }
ZD_INLINE zd_vector3 zd_times3(double s, zd_vector3 a) { return (zd_vector3){s * a.x, s * a.y, s * a.z}; }
ZD_INLINE double zd_inner3(zd_vector3 a, zd_vector3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

ZD_INLINE zd_vector3 zd_cross3(zd_vector3 a, zd_vector3 b)
{
    return (zd_vector3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

ZD_INLINE zd_vector3 zd_rotated3(const zd_rotation *R, zd_vector3 a)
{
    return zd_plus3(zd_plus3(zd_times3(a.x, R->x), zd_times3(a.y, R->y)), zd_times3(a.z, R->z));
}

ZD_INLINE zd_vector3 zd_rotated_back3(const zd_rotation *R, zd_vector3 a)
{
    return (zd_vector3){zd_inner3(R->x, a), zd_inner3(R->y, a), zd_inner3(R->z, a)};
}

ZD_INLINE void zd_space_add_wrench(zd_space_wrench *to, double s, zd_space_wrench what)
{
    to->force = zd_plus3(to->force, zd_times3(s, what.force));
    to->torque = zd_plus3(to->torque, zd_times3(s, what.torque));
}
