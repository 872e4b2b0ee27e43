/* Products with C of mechanisms whose constraints are all revolute joints: C is not stored for them. */
#ifndef ZD_PLANE_PRODUCTS_H
#define ZD_PLANE_PRODUCTS_H

#include "../plan.h"

extern const zd_operations zd_plane_products;

#endif
