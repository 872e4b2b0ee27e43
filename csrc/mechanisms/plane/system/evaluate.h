/* The terms of the equations of motion of a mechanism. */
#ifndef ZD_PLANE_EVALUATE_H
#define ZD_PLANE_EVALUATE_H

#include "../plan.h"

zd_evaluate zd_plane_evaluate;

#endif
