#include "road.h"

/* What the safeguards of the general road compare a step's end with is kept only where steps take that. */
static int begin_general_road(zd_course *course)
{
    course->motion->road.was_taken = 0;
    return zd_safeguards_begin(course->safeguards, course->step);
}

int zd_road_choose(zd_course *course)
{
    zd_motion *motion = course->motion;
    zd_direct_choose(motion);
    return motion->road.was_taken && !zd_is_direct(motion) ? begin_general_road(course) : ZD_DONE;
}

int zd_road_leave(zd_course *course)
{
    zd_direct_leave(course->motion);
    zd_direct_forget_energy(course->motion);
    int status = zd_stepper_return(course->stepper);
    return status ? status : begin_general_road(course);
}
