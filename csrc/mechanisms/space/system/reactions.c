/* Reactions of joints. With the sign of (2), M vdot + d = f - C^T lambda, a row acts on bodies with -lambda times its wrenches; the
 * reaction of an inboard joint is computed by the tree. */
#include "system.h"

#include "../../common/actions.h"
#include "../bodies.h"

/* Reaction of a joint on its second body, about a point of it. */
typedef struct reaction_at {
    int body;
    zd_vector3 point;
    zd_space_wrench *reaction;
} reaction_at;

/* The joint's point of the second body; of what rolls, the contact. */
static zd_vector3 point_of(const zd_space *self, const zd_space_frame *frame, int joint)
{
    const zd_space_joint *of = self->joint + joint;
    if (zd_space_joint_kind_of(of->kind)->rolls) {
        const zd_relation *row = self->elements.row + self->planned[joint].rows[0];
        return zd_space_contact(self->quantity + self->elements.term[row->first].quantity, frame->pose);
    }
    return zd_space_point_of(frame->pose + of->second, of->point2);
}

/* The joint's second body is either one of the marker quantity's. */
static void add_quantity(const zd_readings *at, void *to, int index, double force)
{
    const zd_space_quantity *quantity = ((const zd_space *)at->mechanism)->quantity + index;
    const zd_space_pose *pose = ((const zd_space_frame *)at->frame)->pose;
    const reaction_at *of = to;
    const zd_space_reading reading = zd_space_quantity_read(quantity, pose);
    zd_space_wrench what = quantity->second == of->body ? reading.second : reading.first;
    what.torque = zd_plus3(what.torque, zd_cross3(zd_minus3(pose[of->body].at, of->point), what.force));
    zd_space_add_wrench(of->reaction, force, what);
}

int zd_space_joint_reaction(const zd_space *self, const zd_space_frame *frame, int joint, const zd_measured_state *at,
                            zd_space_wrench *reaction)
{
    const zd_space_planned_joint *planned = self->planned + joint;
    reaction_at to = {self->joint[joint].second, point_of(self, frame, joint), reaction};
    const zd_readings readings = zd_space_frame_readings(self, frame);
    const zd_actions actions = {&self->elements, &readings, add_quantity, &to};
    int status = ZD_DONE;
    *reaction = (zd_space_wrench){{0, 0, 0}, {0, 0, 0}};
    if (planned->carried) status = self->carrying.transmit(self, frame, joint, to.point, at, reaction);
    else zd_joint_rows_act(&actions, planned->row_count, planned->rows, at->lambda);
    return status ? status : zd_drives_act(&actions, joint, at);
}
