/* Choice of the evaluation path, and the change from closed form to matrices within a step. */
#ifndef ZD_PATH_H
#define ZD_PATH_H

#include "step_loop.h"

/* Chooses the evaluation path of the step that begins at the point. */
int zd_path_choose(zd_step_loop *loop);
/* True if a step with this status must be repeated on the matrix path. */
static inline int zd_path_is_left(const zd_step_loop *loop, int status) { return status && zd_is_direct(loop->motion); }
/* Returns to the start of the step and takes the matrix path. */
int zd_path_leave(zd_step_loop *loop);

#endif
