/* Layout of the scratch memory of a mechanism in space. */
#include "bodies.h"
#include "plan.h"

void zd_space_frame_divide(zd_space *self)
{
    const size_t bodies = (size_t)self->bodies + 1, longest = (size_t)self->elements.longest, one = sizeof(double);
    const size_t joints = (size_t)self->point_joints.count, carried = self->carrying.place ? bodies : 0;
    const size_t bytes[ZD_SPACE_ARRAYS] = {
        bodies * sizeof(zd_space_pose), bodies * sizeof(zd_space_twist), bodies * sizeof(zd_space_wrench), 4 * bodies * one,
        (size_t)self->unwrapped.count * one, joints * sizeof(zd_arms), joints * sizeof(zd_directions), (size_t)self->point_joints.turns * one,
        longest * one, longest * one, (longest + 3) * one, carried * sizeof(zd_space_twist), (size_t)self->carrying.scratch * one,
        one, one, one, (size_t)self->elements.m * one, ZD_BODY_VELOCITIES * bodies * one};
    zd_divide(ZD_SPACE_ARRAYS, ZD_SPACE_OF_MEASURES, bytes, self->frame_at, &self->system, &self->measures);
}

void zd_space_frame_of(const zd_space *space, double *scratch, zd_space_frame *frame)
{
    zd_find_arrays(ZD_SPACE_ARRAYS, space->frame_at, scratch, frame);
    frame->inputs = NULL;
    if (!space->carrying.place) frame->bias = NULL;
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
