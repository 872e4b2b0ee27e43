/* Reading gauges: what they say, how fast that changes, and what a unit force along them is for each body. */
#ifndef ZD_PLANE_GAUGE_H
#define ZD_PLANE_GAUGE_H

#include "tables.h"
#include "tree.h"

typedef struct zd_plane_reading {
    double value;
    zd_plane_wrench first, second;    /* value's rate = first . twist of the first body + second . twist of the second */
} zd_plane_reading;

zd_plane_reading zd_plane_gauge_read(const zd_plane_gauge *gauge, const zd_plane_pose *pose);
/* Returns the rate, and in `bias` what its derivative by time has besides the accelerations of coordinates. */
double zd_plane_gauge_rate(const zd_plane_gauge *gauge, const zd_plane_pose *pose, const zd_plane_twist *twist, double *bias);
/* The point of a gauge or joint on one of its bodies, from the drawing's origin. */
zd_vector zd_point_of(const zd_plane_pose *pose, const double *point);

#endif
