/* The scratch of a mechanism in space, laid out once for its size and once for its parts. */
#include "bodies.h"
#include "plan.h"

enum { POSE = sizeof(zd_space_pose) / sizeof(double), TWIST = sizeof(zd_space_twist) / sizeof(double),
      WRENCH = sizeof(zd_space_wrench) / sizeof(double),
       QUATERNION = 4, ARMS = sizeof(zd_arms) / sizeof(double), DIRECTIONS = sizeof(zd_directions) / sizeof(double) };

zd_space_frame zd_space_frame_of(const zd_space *space, double *scratch)
{
    const int all = space->bodies + 1;
    zd_space_frame frame = {.pose = (zd_space_pose *)scratch};
    scratch += all * POSE;
    frame.twist = (zd_space_twist *)scratch;
    scratch += all * TWIST;
    frame.wrench = (zd_space_wrench *)scratch;
    scratch += all * WRENCH;
    frame.quaternion = scratch;
    scratch += all * QUATERNION;
    frame.angle = scratch;
    scratch += space->unwrapped.count;
    frame.arms = (zd_arms *)scratch;
    scratch += space->point_joints.count * ARMS;
    frame.directions = (zd_directions *)scratch;
    scratch += space->point_joints.count * DIRECTIONS;
    frame.turns = scratch;
    scratch += space->point_joints.turns;
    frame.row = scratch;
    scratch += all * ZD_BODY_VELOCITIES;
    frame.is_placed = scratch++;
    frame.is_moving = scratch++;
    frame.is_least = scratch++;
    frame.least = scratch;
    scratch += space->elements.m;
    frame.x = scratch;
    frame.xdot = frame.x + space->elements.longest;
    frame.out = frame.xdot + space->elements.longest;
    if (!space->carrying.place) return frame;
    frame.bias = (zd_space_twist *)(frame.out + space->elements.longest + 3);
    frame.carried = (double *)(frame.bias + all);
    return frame;
}

int zd_space_frame_size(const zd_space *space)
{
    return (space->bodies + 1) * (POSE + TWIST + WRENCH + QUATERNION + ZD_BODY_VELOCITIES) + space->point_joints.count * (ARMS + DIRECTIONS)
         + space->unwrapped.count + space->point_joints.turns + 3 + space->elements.m + 3 * space->elements.longest + 3
             + (space->carrying.place ? (space->bodies + 1) * TWIST + space->carrying.scratch : 0);
}

void zd_space_frame_place(const zd_space *space, const zd_space_frame *frame, const double *p)
{
    if (space->carrying.place) space->carrying.place(space, frame, p);
    else zd_bodies_place(space->bodies, space->body, p, frame->pose, frame->quaternion);
    zd_unwrapped_angles_read(space, frame, p);
}

void zd_space_frame_move(const zd_space *space, const zd_space_frame *frame, const double *v)
{
    if (space->carrying.move) space->carrying.move(space, frame, v);
    else zd_bodies_move(space->bodies, space->body, frame->pose, v, frame->twist);
}

static double value_of(const void *mechanism, const void *frame, int quantity)
{
    const zd_space *self = mechanism;
    const zd_space_frame *at = frame;
    return zd_space_quantity_value(self->quantity + quantity, at->pose, at->angle);
}

static double rate_of(const void *mechanism, const void *frame, int quantity)
{
    const zd_space *self = mechanism;
    const zd_space_frame *at = frame;
    return zd_space_quantity_rate(self->quantity + quantity, at->pose, at->twist);
}

zd_readings zd_space_frame_readings(const zd_space *space, const zd_space_frame *frame)
{
    return (zd_readings){value_of, rate_of, space, frame, frame->inputs, frame->x, frame->xdot, frame->out};
}
