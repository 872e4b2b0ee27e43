/* Natural units, in which tolerances are the same whatever units a system is written in. */
#ifndef ZD_UNITS_H
#define ZD_UNITS_H

#include "point.h"

int zd_point_measure(zd_point *point);              /* units and sizes, from where the point is */
double zd_point_violation(const zd_point *point);   /* largest |Phi| in units of its row's size; needs Phi */

#endif
