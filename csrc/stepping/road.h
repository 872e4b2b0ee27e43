/* Steps along the direct road, and those that leave it. */
#ifndef ZD_ROAD_H
#define ZD_ROAD_H

#include "course.h"

/* Which road the step takes that begins where the motion is. */
int zd_road_choose(zd_course *course);
/* Whether a step with this status has to be made again, on the general road. */
static inline int zd_road_is_left(const zd_course *course, int status) { return status && zd_is_direct(course->motion); }
/* Back to where the step began, and onto the general road. */
int zd_road_leave(zd_course *course);

#endif
