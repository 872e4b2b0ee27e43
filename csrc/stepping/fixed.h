/* Fixed steps. */
#ifndef ZD_FIXED_H
#define ZD_FIXED_H

#include "step_loop.h"

/* Makes the next step. One that cannot be corrected or is not accepted is repeated in parts; if these fail, too, its status is returned. */
int zd_fixed_step(zd_step_loop *loop);

#endif
