/* Independent coordinates where unit quaternions make p longer than v: how far p is from a base, in directions of velocities. */
#ifndef ZD_INCREMENTS_H
#define ZD_INCREMENTS_H

#include "../point/point.h"

typedef struct zd_increments {
    int nq, nv;             /* 0, 0: there are none, as there are no quaternions */
    double *base;           /* (nq,): where the step begins */
    double *inverse;        /* (nv, nq): A(base)^+ */
    double *gram;           /* (nv, nv) */
    double *rounding;       /* (nv,): of each, as p is rounded */
} zd_increments;

zd_increments zd_increments_take(zd_arena *arena, const zd_system *system);
/* From now on about where the point is. */
int zd_increments_begin(zd_increments *self, zd_point *point);
/* Whether p is so near to the base that increments tell well where it is. */
int zd_increments_are_within_reach(const zd_increments *self, const zd_system *system, const double *p);
/* That in the direction of velocity j, where p is; and where p changes at a rate, its rate. */
double zd_increments_value(const zd_increments *self, const zd_point *point, const double *p, int j);
double zd_increments_rate(const zd_increments *self, const double *pdot, int j);
/* row (nv,): its rate is row . v at the point; needs A */
void zd_increments_row(const zd_increments *self, const zd_point *point, int j, double *row);

#endif
