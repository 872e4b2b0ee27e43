/* Kinds of force elements of planar mechanisms: each is one generalized force along each of its marker quantities.
 *
 * Plain declarations only: CFFI parses this text. SI units, radians.
 */
#ifndef ZD_PLANE_FORCES_ELEMENT_H
#define ZD_PLANE_FORCES_ELEMENT_H

#include "../joints/joint.h"

enum { ZD_ELEMENT_QUANTITIES = 3 };

typedef struct zd_plane_element_kind {
    zd_card card;
    int quantities;                     /* their number; lengths stand before angles */
    enum zd_plane_quantity_kind quantity[ZD_ELEMENT_QUANTITIES];
    enum zd_zero zero[ZD_ELEMENT_QUANTITIES];
    int is_spring;                      /* 1: -stiffness value - damping rate; 0: a given force */
    int axes;                           /* 1 if the user gives an axis; 0: the x axis of the first body is taken */
    int at_joint;                       /* 1 if it acts along the angle of a joint that the user gives, from an angle where it is slack */
    const char *measure;                /* name of its scalar measure, "force" or "torque"; NULL: it has both as vectors */
    int sign;                           /* sign of that measure: -1 if it is positive in tension, otherwise 1 */
} zd_plane_element_kind;

int zd_plane_element_kinds(void);
const zd_plane_element_kind *zd_plane_element_kind_of(int row);

#endif
