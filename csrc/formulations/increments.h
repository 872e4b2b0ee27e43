/* Independent coordinates with unit quaternions, where p is longer than v: displacement of p from a base, in the directions of the
 * velocities. */
#ifndef ZD_INCREMENTS_H
#define ZD_INCREMENTS_H

#include "../point/point.h"

typedef struct zd_increments {
    int nq, nv;             /* 0, 0: unused, as there are no quaternions */
    double *base;           /* (nq,): p at the start of the step */
    double *inverse;        /* (nv, nq): A(base)^+ */
    double *gram;           /* (nv, nv) */
    double *rounding;       /* (nv,): rounding error of each increment, from that of p */
} zd_increments;

zd_increments zd_increments_create(zd_arena *arena, const zd_system *system);
/* Sets the base to the p of the point. */
int zd_increments_begin(zd_increments *self, zd_point *point);
/* True if p is near enough to the base for the increments to determine it. */
int zd_increments_are_within_reach(const zd_increments *self, const zd_system *system, const double *p);
/* Increment of p in the direction of velocity j; and its rate, from that of p. */
double zd_increments_value(const zd_increments *self, const zd_point *point, const double *p, int j);
double zd_increments_rate(const zd_increments *self, const double *pdot, int j);
/* row (nv,): the rate of increment j is row . v at the point; needs A. */
void zd_increments_row(const zd_increments *self, const zd_point *point, int j, double *row);

#endif
