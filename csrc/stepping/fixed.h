/* Steps of fixed size. */
#ifndef ZD_FIXED_H
#define ZD_FIXED_H

#include "step_loop.h"

/* A step that has led too far away to be corrected is made in parts; if that does not help, either, it stays so and is named. */
int zd_fixed_step(zd_step_loop *loop);

#endif
