/* The terms of the equations of motion of a mechanism. */
#ifndef ZD_MECHANISM_EVALUATE_H
#define ZD_MECHANISM_EVALUATE_H

#include "plan.h"

zd_evaluate zd_mechanism_evaluate;

#endif
