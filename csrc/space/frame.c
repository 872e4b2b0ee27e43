/* The scratch of a mechanism in space, laid out once for its size and once for its parts. */
#include "plan.h"

enum { POSE = sizeof(zd_pose3) / sizeof(double), TWIST = sizeof(zd_twist3) / sizeof(double), WRENCH = sizeof(zd_wrench3) / sizeof(double) };

zd_frame3 zd_frame3_of(const zd_space *space, double *scratch)
{
    const int all = space->bodies + 1;
    zd_frame3 frame = {.pose = (zd_pose3 *)scratch};
    scratch += all * POSE;
    frame.twist = (zd_twist3 *)scratch;
    scratch += all * TWIST;
    frame.wrench = (zd_wrench3 *)scratch;
    scratch += all * WRENCH;
    frame.row = scratch;
    scratch += all * ZD_BODY_VELOCITIES;
    frame.x = scratch;
    frame.xdot = frame.x + space->longest;
    frame.out = frame.xdot + space->longest;
    return frame;
}

int zd_frame3_size(const zd_space *space)
{
    return (space->bodies + 1) * (POSE + TWIST + WRENCH + ZD_BODY_VELOCITIES) + 3 * space->longest + 3;
}
