#include "path.h"

/* Saves the start of the step for the checks of the matrix path; steps in closed form do not need it. */
static int begin_matrix_path(zd_step_loop *loop)
{
    loop->motion->path.was_taken = 0;
    return zd_safeguards_begin(loop->safeguards, loop->step);
}

int zd_path_choose(zd_step_loop *loop)
{
    zd_motion *motion = loop->motion;
    zd_direct_choose(motion);
    return motion->path.was_taken && !zd_is_direct(motion) ? begin_matrix_path(loop) : ZD_DONE;
}

int zd_path_leave(zd_step_loop *loop)
{
    zd_direct_leave(loop->motion);
    zd_direct_forget_energy(loop->motion);
    int status = zd_stepper_return(loop->stepper);
    return status ? status : begin_matrix_path(loop);
}
