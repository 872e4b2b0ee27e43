/* Reactions of joints. With the sign of (2), M vdot + d = f - C^T lambda, a row acts on bodies with -lambda times its wrenches. So joints
 * that are constraints have theirs from the multipliers; what goes through a joint of the tree is what the bodies further out need for
 * their accelerations beyond what else acts on them. */
#include "system.h"

#include "../tree.h"

/* The joint's point of the second body; where a wheel rolls, the contact. */
static zd_vector point_of(const zd_plane *self, const zd_plane_frame *frame, int joint)
{
    const zd_plane_joint *of = self->joint + joint;
    const zd_plane_pose *first = frame->pose + of->first;
    zd_vector point = zd_point_of(frame->pose + of->second, of->point2);
    if (!zd_plane_joint_kind_of(of->kind)->at_contact) return point;
    zd_vector up = zd_turned(1, zd_rotated(first->cosine, first->sine, (zd_vector){of->axis[0], of->axis[1]}));
    if (!zd_plane_joint_kind_of(of->kind)->takes_axis) {
        const zd_vector apart = zd_minus(point, zd_point_of(first, of->point1));
        up = zd_times(1 / sqrt(zd_inner(apart, apart)), apart);
    }
    return zd_minus(point, zd_times(of->length, up));
}

/* A wrench on a body, with its torque about a point instead of the mass centre. */
static zd_plane_wrench about(zd_plane_wrench what, const zd_plane_pose *body, zd_vector point)
{
    what.torque += zd_cross(zd_minus(body->at, point), what.force);
    return what;
}

/* frame->wrench <- inertia force of each body minus the applied and constraint forces on it, without joints of the tree. */
static int write_needs(const zd_plane *self, const zd_plane_frame *frame, const zd_measured_state *at)
{
    const zd_readings readings = zd_plane_frame_readings(self, frame);
    const zd_actions actions = {&self->elements, &readings, zd_plane_add_force, NULL};
    if (!at->vdot) memset(frame->wrench, 0, (self->tree.bodies + 1) * sizeof *frame->wrench);
    else if (zd_plane_forces_apply(self, frame, at->t)) return ZD_CALLBACK;
    if (zd_rows_act(&actions, at)) return ZD_CALLBACK;
    if (at->vdot) zd_plane_tree_accelerate(&self->tree, frame->pose, frame->twist, at->vdot, frame->spin);
    for (int i = 1; i <= self->tree.bodies; i++) {
        const zd_plane_link *link = self->tree.link + i;
        zd_plane_wrench inertia = {{0, 0}, 0};
        if (at->vdot) inertia = (zd_plane_wrench){zd_times(link->mass, frame->spin[i].speed), link->inertia * frame->spin[i].turn};
        zd_plane_add_wrench(&inertia, -1, frame->wrench[i]);
        frame->wrench[i] = inertia;
    }
    return ZD_DONE;
}

/* Wrench of an inboard joint on its outer body; its component along the joint's coordinate is set to zero exactly. */
static int through_tree(const zd_plane *self, const zd_plane_frame *frame, int joint, zd_vector point, const zd_measured_state *at,
                        zd_plane_wrench *to)
{
    int status = write_needs(self, frame, at), carried = self->planned[joint].carried;
    if (status) return status;
    const zd_plane_pose *pose = frame->pose + carried;
    zd_plane_tree_transmit(&self->tree, frame->pose, frame->wrench);
    zd_plane_wrench through = about(frame->wrench[carried], pose, point);
    enum zd_plane_hang hang = self->tree.link[carried].hang;
    if (hang == ZD_HANGS_TURNING || hang == ZD_HANGS_PINNED) through.torque = 0;
    if (hang == ZD_HANGS_SLIDING)
        through.force = zd_minus(through.force, zd_times(zd_inner(through.force, pose->axis), pose->axis));
    zd_plane_add_wrench(to, self->planned[joint].sign, through);
    return ZD_DONE;
}

#define MECHANISM zd_plane
#define OF(name) zd_plane_##name
#define VECTOR zd_vector

#include "../../common/reactions_of_dimension.h"
