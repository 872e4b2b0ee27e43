/* Kinds of force elements of mechanisms in space: each is one generalized force along each of its marker quantities.
 *
 * Plain declarations only: CFFI parses this text. SI units, radians.
 */
#ifndef ZD_SPACE_FORCES_ELEMENT_H
#define ZD_SPACE_FORCES_ELEMENT_H

#include "../joints/joint.h"

enum { ZD_SPACE_ELEMENT_QUANTITIES = 6 };

typedef struct zd_space_element_kind {
    zd_card card;
    int quantities;             /* their number; lengths stand before angles */
    zd_space_pick pick[ZD_SPACE_ELEMENT_QUANTITIES];
    int is_spring;              /* 1: -stiffness value - damping rate; 0: a given force */
    int axes;                   /* 0; 1: the user gives the axis; 3: an axis and a normal are optional, by default those of the first body */
    int at_joint;               /* 1 if it acts along the angle of a joint that the user gives, from an angle where it is slack */
    const char *measure;        /* name of its scalar measure, "force" or "torque"; NULL: it has both as vectors */
    int sign;                   /* sign of that measure: -1 if it is positive in tension, otherwise 1 */
} zd_space_element_kind;

int zd_space_element_kinds(void);
const zd_space_element_kind *zd_space_element_kind_of(int row); /* NULL: out of range */

#endif
