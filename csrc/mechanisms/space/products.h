/* Products with A and, if all constraints are point joints, with C, without their stored entries. */
#ifndef ZD_SPACE_PRODUCTS_H
#define ZD_SPACE_PRODUCTS_H

#include "plan.h"

extern const zd_operations zd_space_products;       /* products with A only, for any spatial mechanism */
extern const zd_operations zd_point_joint_products;      /* products with A and C, if self->point_joints.are_all */

#endif
