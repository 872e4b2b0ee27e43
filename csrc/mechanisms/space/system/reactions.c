/* Reactions of joints. With the sign of (2), M vdot + d = f - C^T lambda, a row acts on bodies with -lambda times its wrenches; the
 * reaction of an inboard joint is computed by the tree. */
#include "system.h"

#include "../../common/actions.h"
#include "../bodies.h"

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

/* A wrench on a body, with its torque about a point instead of the mass centre. */
static zd_space_wrench about(zd_space_wrench what, const zd_space_pose *body, zd_vector3 point)
{
    what.torque = zd_plus3(what.torque, zd_cross3(zd_minus3(body->at, point), what.force));
    return what;
}

#define MECHANISM zd_space
#define OF(name) zd_space_##name
#define VECTOR zd_vector3
#define through_tree self->carrying.transmit

#include "../../common/reactions_of_dimension.h"
