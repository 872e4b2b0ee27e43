/* Unit quaternions among the coordinates, kept at length one. */
#ifndef ZD_QUATERNIONS_H
#define ZD_QUATERNIONS_H

#include "point.h"

/* Brings those in p (nq,) to length one that are off by more than rounding; returns whether that changed p. */
int zd_quaternions_bring_back(const zd_system *system, double *p);
static inline int zd_quaternions_normalise(const zd_system *system, double *p)
{
    return system->quaternions ? zd_quaternions_bring_back(system, p) : 0;
}

/* Coordinates of the point that follow others are brought to these: what is known there stays. */
static inline void zd_point_follow(zd_point *point)
{
    if (point->system->followers) point->system->follow(point->system->data, point->p);
}

/* The same for where the point is. */
static inline void zd_point_normalise(zd_point *point)
{
    if (zd_quaternions_normalise(point->system, point->p)) point->known = 0;
    zd_point_follow(point);
}

/* The first quaternion in p whose length is none that a rotation can be given with, and that length; -1: there is none. With `any_length`
 * that is zero alone, else whatever is not within 1e-6 of one. */
int zd_quaternions_wrong_length(const zd_system *system, const double *p, int any_length, double *length);
/* The first quaternion whose length would not stay one as pdot = A v, and the velocity with which; -1: there is none. Needs A. */
int zd_quaternions_not_kept(const zd_point *point, int *velocity);

#endif
