/* Reactions of joints. With the sign of (2), M vdot + d = f - C^T lambda, a row acts on bodies with -lambda times its wrenches; the
 * reaction of an inboard joint is computed by the tree. */
#include "reactions.h"

#include "../../common/output_spec.h"
#include "../marker_quantity.h"

typedef struct place {
    int body;               /* the joint's second */
    zd_vector3 point;       /* its point of the joint */
} place;

/* The joint's point of the second body; of what rolls, the contact. */
static place place_of(const zd_space *self, const zd_space_frame *frame, int joint)
{
    const zd_space_joint *of = self->joint + joint;
    if (zd_space_joint_kind_of(of->kind)->rolls) {
        const zd_relation *row = self->elements.row + self->planned[joint].rows[0];
        return (place){of->second, zd_space_contact(self->quantity + self->elements.term[row->first].quantity, frame->pose)};
    }
    return (place){of->second, zd_space_point_of(frame->pose + of->second, of->point2)};
}

/* to += scale times what a unit force along a marker quantity is for a joint's second body, about the joint's point. */
static void add_quantity(const zd_space *self, const zd_space_frame *frame, int index, place at, double scale, zd_space_wrench *to)
{
    const zd_space_quantity *quantity = self->quantity + index;
    const zd_space_reading reading = zd_space_quantity_read(quantity, frame->pose);
    zd_space_wrench what = quantity->second == at.body ? reading.second : reading.first;
    what.torque = zd_plus3(what.torque, zd_cross3(zd_minus3(frame->pose[at.body].at, at.point), what.force));
    zd_space_add_wrench(to, scale, what);
}

static void of_rows(const zd_space *self, const zd_space_frame *frame, int joint, place at, const double *lambda, zd_space_wrench *to)
{
    for (int k = 0; k < self->planned[joint].row_count; k++) {
        const int index = self->planned[joint].rows[k];
        const zd_relation *row = self->elements.row + index;
        for (int i = row->first; i < row->first + row->terms; i++)
            add_quantity(self, frame, self->elements.term[i].quantity, at, -lambda[index] * self->elements.coefficient[i], to);
    }
}

/* Motors of the joint, by rows and by generalized forces, and its damping */
static int of_drives(const zd_space *self, const zd_space_frame *frame, int joint, place at, double t, const double *lambda,
                     zd_space_wrench *to)
{
    const zd_readings readings = zd_space_frame_readings(self, frame);
    double value;
    for (int i = 0; i < self->elements.forces; i++) {
        if (self->elements.force[i].joint != joint) continue;
        if (zd_force_evaluate(&self->elements, &readings, self->elements.force + i, t, &value, NULL)) return ZD_CALLBACK;
        add_quantity(self, frame, self->elements.force[i].quantity, at, value, to);
    }
    for (int i = 0; i < self->elements.relations; i++) {
        const zd_relation *row = self->elements.row + self->elements.row_of_relation[i];
        if (row->joint != joint) continue;
        if (zd_drive_force(&self->elements, &readings, i, 0, t, lambda, &value)) return ZD_CALLBACK;
        add_quantity(self, frame, self->elements.term[row->first].quantity, at, value, to);
    }
    return ZD_DONE;
}

int zd_space_joint_reaction(const zd_space *self, const zd_space_frame *frame, int joint, double t, const double *vdot, const double *lambda,
                            zd_space_wrench *reaction)
{
    const place at = place_of(self, frame, joint);
    int status = ZD_DONE;
    *reaction = (zd_space_wrench){{0, 0, 0}, {0, 0, 0}};
    if (self->planned[joint].carried) status = self->carrying.transmit(self, frame, joint, at.point, t, vdot, lambda, reaction);
    else of_rows(self, frame, joint, at, lambda, reaction);
    return status ? status : of_drives(self, frame, joint, at, t, lambda, reaction);
}
