/* Values, rates and unit forces of marker quantities in space. */
#ifndef ZD_SPACE_MARKER_QUANTITY_H
#define ZD_SPACE_MARKER_QUANTITY_H

#include "bodies.h"
#include "tables.h"

typedef struct zd_space_reading {
    double value;
    zd_space_wrench first, second;   /* value's rate = first . twist of the first body + second . twist of the second */
} zd_space_reading;

zd_space_reading zd_space_quantity_read(const zd_space_quantity *quantity, const zd_space_pose *pose);
/* Value of a marker quantity; one that counts turns takes them from angle (angles,), the joint angles. */
double zd_space_quantity_value(const zd_space_quantity *quantity, const zd_space_pose *pose, const double *angle);
/* The same from its value without turns. */
double zd_space_quantity_counted(const zd_space_quantity *quantity, double value, const double *angle);
/* The angle plus the multiple of 2 pi that is nearest to `near`. */
double zd_with_turns(double angle, double near);
double zd_space_quantity_rate(const zd_space_quantity *quantity, const zd_space_pose *pose, const zd_space_twist *twist);
/* Derivative of the rate by time, without the part that is linear in the bodies' accelerations. */
double zd_space_quantity_bias(const zd_space_quantity *quantity, const zd_space_pose *pose, const zd_space_twist *twist);
/* The same at vdot = 0, where bodies have the accelerations `bias`; NULL: zero. */
double zd_space_quantity_bias_with(const zd_space_quantity *quantity, const zd_space_pose *pose, const zd_space_twist *twist,
                                const zd_space_twist *bias);
/* True if a force along it acts on both bodies with opposite force and opposite torque about any point. */
int zd_space_quantity_is_mutual(const zd_space_quantity *quantity);
/* C of enum zd_space_quantity_kind. */
zd_vector3 zd_space_contact(const zd_space_quantity *quantity, const zd_space_pose *pose);
/* Point of a body, from the global origin. */
zd_vector3 zd_space_point_of(const zd_space_pose *pose, const double *point);

#endif
