/* Steps along the direct road, and those that leave it. */
#ifndef ZD_PATH_H
#define ZD_PATH_H

#include "step_loop.h"

/* Which road the step takes that begins where the motion is. */
int zd_path_choose(zd_step_loop *loop);
/* Whether a step with this status has to be made again, on the general road. */
static inline int zd_path_is_left(const zd_step_loop *loop, int status) { return status && zd_is_direct(loop->motion); }
/* Back to where the step began, and onto the general road. */
int zd_path_leave(zd_step_loop *loop);

#endif
