/* With a, o and b as in enum zd_space_quantity_kind, and a x o, the axis, a direction of the first body,
 *
 *     angle' = (a x o) . (omega2 - omega1)
 *
 * where a x o is perpendicular to b, as it is if the joint is closed; of a universal joint whose axes are not perpendicular the torque of
 * the marker quantity stands for a x o. The angle is atan2(o . b, a . b) plus the multiple of 2 pi that brings
 * it nearest to the coordinate. This removes the error of the integrated rate in each step; turns are correct while it is below pi.
 */
#include "plan.h"

#include "bodies.h"

int zd_unwrapped_angles_of(const zd_space_joint *joint)
{
    const zd_space_coordinate *coordinate = zd_space_joint_kind_of(joint->kind)->coordinate;
    int turns = 0;
    for (int i = 0; i < ZD_SPACE_COORDINATES && coordinate[i].name; i++) turns += coordinate[i].pick.quantity == ZD_SPACE_ANGLE;
    return turns;
}

void zd_unwrapped_angles_create(zd_unwrapped_angles *self, zd_arena *arena, size_t joints)
{
    self->angle = zd_arena_bytes(arena, ZD_SPACE_COORDINATES * joints * sizeof *self->angle);
    self->axis = zd_arena_bytes(arena, ZD_SPACE_COORDINATES * joints * sizeof *self->axis);
    self->joint = zd_arena_bytes(arena, ZD_SPACE_COORDINATES * joints * sizeof *self->joint);
    self->place = zd_arena_bytes(arena, ZD_SPACE_COORDINATES * joints * sizeof *self->place);
}

void zd_unwrapped_angles_plan(zd_unwrapped_angles *self, int joints, const zd_space_joint *joint, int at)
{
    for (int j = 0; j < joints; j++) {
        const int before = self->count;
        for (int i = 0, angles = zd_unwrapped_angles_of(joint + j); i < ZD_SPACE_COORDINATES && self->count < before + angles; i++) {
            const zd_space_quantity quantity = zd_space_coordinate_quantity(joint + j, i, before);
            if (!quantity.counted) continue;
            const int is_skew = angles == 2 && joint[j].along != 0;
            self->axis[self->count] = zd_times3(!is_skew, zd_cross3(zd_vector3_of(quantity.a), zd_vector3_of(quantity.o)));
            self->joint[self->count] = j;
            self->place[self->count] = at + self->count;
            self->angle[self->count++] = quantity;
        }
    }
}

void zd_unwrapped_angles_read(const zd_space *space, const zd_space_frame *frame, const double *p)
{
    for (int k = 0; k < space->unwrapped.count; k++) frame->angle[k] = p[space->unwrapped.place[k]];
}

static zd_vector3 spin_of(const zd_space *space, const zd_space_frame *frame, int body, const double *x)
{
    const zd_space_planned_body *of = space->body + body;
    if (!body || !of->turns) return (zd_vector3){0, 0, 0};
    return zd_rotated3(&frame->pose[body].turned, zd_vector3_of(x + of->v + ZD_POINT_COORDINATES));
}

zd_vector3 zd_unwrapped_angle_axis(const zd_space *space, const zd_space_frame *frame, int k)
{
    const zd_space_quantity *angle = space->unwrapped.angle + k;
    const zd_vector3 axis = space->unwrapped.axis[k];
    if (!(zd_inner3(axis, axis) > 0)) return zd_space_quantity_wrenches(angle, frame->pose).second.torque;
    return zd_rotated3(&frame->pose[angle->first].turned, axis);
}

void zd_unwrapped_angles_rate(const zd_space *space, const zd_space_frame *frame, const double *x, double *pdot)
{
    for (int k = 0; k < space->unwrapped.count; k++) {
        const zd_space_quantity *angle = space->unwrapped.angle + k;
        const zd_vector3 axis = zd_unwrapped_angle_axis(space, frame, k);
        pdot[space->unwrapped.place[k]] = zd_inner3(axis, zd_minus3(spin_of(space, frame, angle->second, x),
                                                                    spin_of(space, frame, angle->first, x)));
    }
}

/* x' = q x q^-1 of a unit quaternion, or of its inverse; that of the ground turns nothing. */
static zd_vector3 turned(const zd_space *space, int body, const double *p, double sign, zd_vector3 x)
{
    if (!body || !space->body[body].turns) return x;
    const double *q = p + space->body[body].p + ZD_POINT_COORDINATES;
    const zd_vector3 axis = {sign * q[1], sign * q[2], sign * q[3]}, twice = zd_times3(2, zd_cross3(axis, x));
    return zd_plus3(zd_plus3(x, zd_times3(q[0], twice)), zd_cross3(axis, twice));
}

void zd_space_follow(const void *data, double *p)
{
    const zd_space *self = data;
    for (int k = 0; k < self->unwrapped.count; k++) {
        const zd_space_quantity *angle = self->unwrapped.angle + k;
        const zd_vector3 b = turned(self, angle->first, p, -1, turned(self, angle->second, p, 1, zd_vector3_of(angle->b)));
        double *follower = p + self->unwrapped.place[k];
        *follower = zd_with_turns(atan2(zd_inner3(zd_vector3_of(angle->o), b), zd_inner3(zd_vector3_of(angle->a), b)), *follower);
    }
}
