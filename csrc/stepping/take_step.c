#include "step_loop.h"

#include "../constraints/rank.h"
#include "adaptive.h"
#include "fixed.h"
#include "path.h"
#include "variables.h"

int zd_step_loop_take_step(zd_step_loop *loop)
{
    zd_motion *motion = loop->motion;
    zd_rank *rank = motion->point->rank;
    loop->step++;
    int status = zd_variables_use_chosen(loop->stepper);
    if (!status && motion->path.direct && !zd_direct_continues(motion)) status = zd_path_choose(loop);
    if (status) return status;
    status = loop->settings->step > 0 ? zd_fixed_step(loop) : zd_adaptive_step(loop);
    if (rank->was_deficient) motion->statistics.rank_drops++;
    rank->was_deficient = rank->was_doubtful = 0;
    if (!status) motion->statistics.steps++;
    if (!status && zd_is_direct(motion)) motion->statistics.direct_steps++;
    return status;
}
