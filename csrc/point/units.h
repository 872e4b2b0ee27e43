/* Characteristic scales, which make tolerances independent of the units of a system. */
#ifndef ZD_UNITS_H
#define ZD_UNITS_H

#include "point.h"

int zd_point_measure(zd_point *point);              /* computes scales and sizes at the present point */
double zd_point_violation(const zd_point *point);   /* largest |Phi| relative to the size of its constraint; requires Phi */

#endif
