/* Normalization and checks of unit quaternions among the coordinates. */
#ifndef ZD_QUATERNIONS_H
#define ZD_QUATERNIONS_H

#include "point.h"

/* Normalizes the quaternions in p (nq,) whose length differs from one by more than rounding; returns true if p has changed. */
int zd_quaternions_bring_back(const zd_system *system, double *p);
static inline int zd_quaternions_normalise(const zd_system *system, double *p)
{
    return system->quaternions ? zd_quaternions_bring_back(system, p) : 0;
}

/* Updates the coordinates of the point that are functions of others; known quantities stay valid. */
static inline void zd_point_follow(zd_point *point)
{
    if (point->system->followers) point->system->follow(point->system->data, point->p);
}

/* Normalizes the point's quaternions, and updates its dependent coordinates. */
static inline void zd_point_normalise(zd_point *point)
{
    if (zd_quaternions_normalise(point->system, point->p)) point->known = 0;
    zd_point_follow(point);
}

/* Index of the first quaternion in p that is not a rotation, and its length; -1: none. With `any_length` only zero length is refused,
 * otherwise all lengths that differ from one by more than 1e-6. */
int zd_quaternions_wrong_length(const zd_system *system, const double *p, int any_length, double *length);
/* Index of the first quaternion whose length pdot = A v changes, and the velocity that changes it; -1: none. Requires A. */
int zd_quaternions_not_kept(const zd_point *point, int *velocity);

#endif
