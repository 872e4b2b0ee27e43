#include "course.h"

#include "../constraints/rank.h"
#include "adaptive.h"
#include "fixed.h"
#include "road.h"
#include "variables.h"

int zd_course_take_step(zd_course *course)
{
    zd_motion *motion = course->motion;
    zd_rank *rank = motion->point->rank;
    course->step++;
    int status = zd_variables_use_chosen(course->stepper);
    if (!status && motion->road.direct && !zd_direct_continues(motion)) status = zd_road_choose(course);
    if (status) return status;
    status = course->settings->step > 0 ? zd_fixed_step(course) : zd_adaptive_step(course);
    if (rank->was_deficient) motion->statistics.rank_drops++;
    rank->was_deficient = rank->was_doubtful = 0;
    if (!status) motion->statistics.steps++;
    if (!status && zd_is_direct(motion)) motion->statistics.direct_steps++;
    return status;
}
