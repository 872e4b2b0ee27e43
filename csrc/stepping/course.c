#include "course.h"

#include "variables.h"

int zd_course_use_dependent(zd_course *course)
{
    int status = zd_variables_use_dependent(course->stepper);
    return status || !course->safeguards->guard.has_begun ? status : zd_safeguards_begin(course->safeguards, course->step + 1);
}
