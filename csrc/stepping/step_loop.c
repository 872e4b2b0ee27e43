#include "step_loop.h"

#include "variables.h"

int zd_step_loop_use_dependent(zd_step_loop *loop)
{
    int status = zd_variables_use_dependent(loop->stepper);
    return status || !loop->safeguards->guard.has_begun ? status : zd_safeguards_begin(loop->safeguards, loop->step + 1);
}
