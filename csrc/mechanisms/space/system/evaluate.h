/* The terms of the equations of motion of a mechanism in space. */
#ifndef ZD_SPACE_EVALUATE_H
#define ZD_SPACE_EVALUATE_H

#include "../plan.h"

zd_evaluate zd_space_evaluate;

#endif
