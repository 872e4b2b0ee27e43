/* As in ../space/unwrapped_angles.c: the rate is that about the joint's axis, and the angle is that between both attitudes plus the nearest
 * multiple of 2 pi. */
#include "links.h"

#include "../space/bodies.h"

/* True if the k-th angle belongs to a joint outside the tree, so that it is a dependent coordinate. */
static int follows(const zd_space *space, int k) { return !space->planned[space->unwrapped.joint[k]].carried; }

void zd_space_tree_write_rates(const zd_space *space, const zd_space_frame *frame, double *A)
{
    for (int k = 0; k < space->unwrapped.count; k++) {
        const zd_space_quantity *angle = space->unwrapped.angle + k;
        if (!follows(space, k)) continue;
        const zd_vector3 axis = zd_unwrapped_angle_axis(space, frame, k);
        const zd_space_reading rate = {.first = {.torque = zd_times3(-1, axis)}, .second = {.torque = axis}};
        zd_space_tree_act(space, frame, angle, 1, &rate, A + space->unwrapped.place[k] * zd_space_tree_of(space)->nv);
    }
}

void zd_space_tree_follow(const void *data, double *p)
{
    const zd_space *space = data;
    const zd_space_tree *tree = zd_space_tree_of(space);
    for (int k = 0; k < space->unwrapped.count; k++) {
        const zd_space_quantity *angle = space->unwrapped.angle + k;
        if (!follows(space, k)) continue;
        const zd_rotation first = zd_space_tree_attitude(tree, angle->first, p), second = zd_space_tree_attitude(tree, angle->second, p);
        const zd_vector3 b = zd_rotated3(&second, zd_vector3_of(angle->b));
        const double x = zd_inner3(zd_rotated3(&first, zd_vector3_of(angle->a)), b),
            y = zd_inner3(zd_rotated3(&first, zd_vector3_of(angle->o)), b);
        double *at = p + space->unwrapped.place[k];
        *at = zd_with_turns(atan2(y, x), *at);
    }
}
