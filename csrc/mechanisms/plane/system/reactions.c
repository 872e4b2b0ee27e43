/* Reactions of joints. With the sign of (2), M vdot + d = f - C^T lambda, a row acts on bodies with -lambda times its wrenches. So joints
 * that are constraints have theirs from the multipliers; what goes through a joint of the tree is what the bodies further out need for
 * their accelerations beyond what else acts on them. */
#include "reactions.h"

#include "../../common/output_spec.h"
#include "../marker_quantity.h"
#include "forces.h"
#include "rows.h"

/* The joint's point of the second body; where a wheel rolls, the contact. */
static zd_vector point_of(const zd_plane_frame *frame, const zd_plane_joint *joint)
{
    const zd_plane_pose *first = frame->pose + joint->first;
    zd_vector point = zd_point_of(frame->pose + joint->second, joint->point2);
    if (!zd_plane_joint_kind_of(joint->kind)->at_contact) return point;
    zd_vector up = zd_turned(1, zd_rotated(first->cosine, first->sine, (zd_vector){joint->axis[0], joint->axis[1]}));
    return zd_minus(point, zd_times(joint->length, up));
}

/* A wrench on a body, with its torque about a point instead of the mass centre. */
static zd_plane_wrench about(zd_plane_wrench what, const zd_plane_pose *body, zd_vector point)
{
    what.torque += zd_cross(zd_minus(body->at, point), what.force);
    return what;
}

/* frame->wrench <- inertia force of each body minus the applied and constraint forces on it, without joints of the tree. */
static int write_needs(const zd_plane *self, const zd_plane_frame *frame, double t, const double *vdot, const double *lambda)
{
    const zd_readings at = zd_plane_frame_readings(self, frame);
    int status = zd_plane_forces_apply(self, frame, t);
    if (status) return status;
    for (int i = 0; i < self->elements.m; i++) {
        zd_combined all;
        if (zd_combine(&self->elements, &at, self->elements.row + i, t, &all)) return ZD_CALLBACK;
        zd_plane_row_act(self, frame, self->elements.row + i, all.factors, -lambda[i]);
    }
    zd_plane_tree_accelerate(&self->tree, frame->pose, frame->twist, vdot, frame->spin);
    for (int i = 1; i <= self->tree.bodies; i++) {
        const zd_plane_link *link = self->tree.link + i;
        zd_plane_wrench inertia = {zd_times(link->mass, frame->spin[i].speed), link->inertia * frame->spin[i].turn};
        zd_plane_add_wrench(&inertia, -1, frame->wrench[i]);
        frame->wrench[i] = inertia;
    }
    return ZD_DONE;
}

/* Wrench of an inboard joint on its outer body; its component along the joint's coordinate is set to zero exactly. */
static int of_tree(const zd_plane *self, const zd_plane_frame *frame, int joint, zd_vector point, double t, const double *vdot,
                   const double *lambda, zd_plane_wrench *to)
{
    int status = write_needs(self, frame, t, vdot, lambda), carried = self->planned[joint].carried;
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

/* to += scale times what a unit force along a marker quantity is for its second body, about the point. */
static void add_quantity(const zd_plane *self, const zd_plane_frame *frame, int index, zd_vector point, double scale, zd_plane_wrench *to)
{
    const zd_plane_quantity *quantity = self->quantity + index;
    zd_plane_add_wrench(to, scale, about(zd_plane_quantity_read(quantity, frame->pose).second, frame->pose + quantity->second, point));
}

static void of_rows(const zd_plane *self, const zd_plane_frame *frame, int joint, zd_vector point, const double *lambda, zd_plane_wrench *to)
{
    for (int k = 0; k < self->planned[joint].row_count; k++) {
        const zd_relation *row = self->elements.row + self->planned[joint].rows[k];
        for (int i = 0; i < row->terms; i++) {
            const zd_quantity_term *term = self->elements.term + row->first + i;
            add_quantity(self, frame, term->quantity, point, -lambda[row - self->elements.row] * term->coefficient, to);
        }
    }
}

/* Motors of the joint, by rows and by generalized forces, and its damping */
static int of_drives(const zd_plane *self, const zd_plane_frame *frame, int joint, zd_vector point, double t, const double *lambda,
                     zd_plane_wrench *to)
{
    const zd_readings at = zd_plane_frame_readings(self, frame);
    double value;
    for (int i = 0; i < self->elements.forces; i++) {
        if (self->elements.force[i].joint != joint) continue;
        if (zd_force_evaluate(&self->elements, &at, self->elements.force + i, t, &value, NULL)) return ZD_CALLBACK;
        add_quantity(self, frame, self->elements.force[i].quantity, point, value, to);
    }
    for (int i = 0; i < self->elements.relations; i++) {
        const zd_relation *row = self->elements.row + self->elements.row_of_relation[i];
        if (row->joint != joint) continue;
        if (zd_drive_force(&self->elements, &at, i, 0, t, lambda, &value)) return ZD_CALLBACK;
        add_quantity(self, frame, self->elements.term[row->first].quantity, point, value, to);
    }
    return ZD_DONE;
}

int zd_plane_joint_reaction(const zd_plane *self, const zd_plane_frame *frame, int joint, double t, const double *vdot, const double *lambda,
                      zd_plane_wrench *reaction)
{
    zd_vector point = point_of(frame, self->joint + joint);
    *reaction = (zd_plane_wrench){.torque = 0};
    int status = ZD_DONE;
    if (self->planned[joint].carried) status = of_tree(self, frame, joint, point, t, vdot, lambda, reaction);
    else of_rows(self, frame, joint, point, lambda, reaction);
    return status ? status : of_drives(self, frame, joint, point, t, lambda, reaction);
}
