/* Reading gauges of space: what they say, how fast that changes, and what a unit force along them is for each body. */
#ifndef ZD_SPACE_GAUGE_H
#define ZD_SPACE_GAUGE_H

#include "bodies.h"
#include "tables.h"

typedef struct zd_space_reading {
    double value;
    zd_space_wrench first, second;   /* value's rate = first . twist of the first body + second . twist of the second */
} zd_space_reading;

zd_space_reading zd_space_gauge_read(const zd_space_gauge *gauge, const zd_space_pose *pose);
/* Its value, with the turns that it counts, of which angle (turns,) tells. */
double zd_space_gauge_value(const zd_space_gauge *gauge, const zd_space_pose *pose, const double *angle);
/* The same from what it reads without turns. */
double zd_space_gauge_counted(const zd_space_gauge *gauge, double value, const double *angle);
/* An angle with as many turns as bring it nearest to another. */
double zd_with_turns(double angle, double near);
double zd_space_gauge_rate(const zd_space_gauge *gauge, const zd_space_pose *pose, const zd_space_twist *twist);
/* What the derivative of the rate by time has besides the accelerations of bodies. */
double zd_space_gauge_bias(const zd_space_gauge *gauge, const zd_space_pose *pose, const zd_space_twist *twist);
/* The same besides those of coordinates, where bodies have the accelerations `bias` if coordinates have none; NULL: they have none either. */
double zd_space_gauge_bias_with(const zd_space_gauge *gauge, const zd_space_pose *pose, const zd_space_twist *twist, const zd_space_twist *bias);
/* Whether a force along it does the opposite to the first body of what it does to the second. */
int zd_space_gauge_is_mutual(const zd_space_gauge *gauge);
/* C of enum zd_space_gauge_kind. */
zd_vector3 zd_space_contact(const zd_space_gauge *gauge, const zd_space_pose *pose);
/* A point of a body, from the drawing's origin. */
zd_vector3 zd_space_point_of(const zd_space_pose *pose, const double *point);

#endif
