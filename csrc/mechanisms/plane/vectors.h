/* Vectors of the plane. */
#ifndef ZD_PLANE_VECTORS_H
#define ZD_PLANE_VECTORS_H

#include "../../linalg/small.h"
#include "link.h"

/* Force at a body's mass centre, and torque. */
typedef struct zd_plane_wrench {
    zd_vector force;
    double torque;
} zd_plane_wrench;

ZD_INLINE zd_vector zd_plus(zd_vector a, zd_vector b) { return (zd_vector){a.x + b.x, a.y + b.y}; }
ZD_INLINE zd_vector zd_minus(zd_vector a, zd_vector b) { return (zd_vector){a.x - b.x, a.y - b.y}; }
ZD_INLINE zd_vector zd_times(double s, zd_vector a) { return (zd_vector){s * a.x, s * a.y}; }
ZD_INLINE double zd_inner(zd_vector a, zd_vector b) { return a.x * b.x + a.y * b.y; }
ZD_INLINE double zd_cross(zd_vector a, zd_vector b) { return a.x * b.y - a.y * b.x; }

/* turn x a, of a rotation about the axis that points out of the plane */
ZD_INLINE zd_vector zd_turned(double turn, zd_vector a) { return (zd_vector){-turn * a.y, turn * a.x}; }

ZD_INLINE zd_vector zd_rotated(double cosine, double sine, zd_vector a)
{
    return (zd_vector){cosine * a.x - sine * a.y, sine * a.x + cosine * a.y};
}

ZD_INLINE void zd_plane_add_wrench(zd_plane_wrench *to, double s, zd_plane_wrench what)
{
    to->force = zd_plus(to->force, zd_times(s, what.force));
    to->torque += s * what.torque;
}

#endif
