/* Values, rates and unit forces of marker quantities in the plane. */
#ifndef ZD_PLANE_MARKER_QUANTITY_H
#define ZD_PLANE_MARKER_QUANTITY_H

#include "tables.h"
#include "tree.h"

typedef struct zd_plane_reading {
    double value;
    zd_plane_wrench first, second;    /* value's rate = first . twist of the first body + second . twist of the second */
} zd_plane_reading;

zd_plane_reading zd_plane_quantity_read(const zd_plane_quantity *quantity, const zd_plane_pose *pose);
/* Returns the rate; bias <- its derivative by time at vdot = 0. */
double zd_plane_quantity_rate(const zd_plane_quantity *quantity, const zd_plane_pose *pose, const zd_plane_twist *twist, double *bias);
/* Point of a marker quantity or joint on one of its bodies, from the global origin. */
zd_vector zd_point_of(const zd_plane_pose *pose, const double *point);

#endif
