/* Products with A and, of a mechanism whose rows are all of sockets, with C, without their entries. */
#ifndef ZD_SPACE_PRODUCTS_H
#define ZD_SPACE_PRODUCTS_H

#include "plan.h"

extern const zd_operations zd_space_products;       /* of any mechanism: with A alone */
extern const zd_operations zd_point_joint_products;      /* where self->sockets.are_all */

#endif
