/* The equations of motion (1), (2), (3), (5), (6) of a mechanism in space, from its tables. */
#include "system.h"

#include "../../../linalg/small.h"
#include "../plan.h"

enum { ROWS = ZD_PHI | ZD_C | ZD_PHI_T | ZD_XI };

static int write_force(const zd_space *self, const zd_space_frame *frame, double t, double *f)
{
    if (!self->elements.forces) {
        zd_copy_all(self->system.nv, self->weight, f);
        return ZD_DONE;
    }
    const int status = zd_space_forces_apply(self, frame, t);
    zd_bodies_gather(self->bodies, self->body, frame->pose, frame->wrench, f);
    return status;
}

/* True if a wanted term depends on velocities. */
static int is_moving(const zd_space *self, int want)
{
    return want & (ZD_XI | ZD_POWER) || (want & ZD_FORCE && self->elements.has_velocity_forces) || (want & ROWS && self->elements.law);
}

int zd_space_evaluate(const void *data, int want, double t, const double *p, const double *v, const zd_terms *out)
{
    const zd_space *self = data;
    const int bodies = self->bodies;
    zd_space_frame frame;
    zd_space_frame_of(self, out->scratch, &frame);
    frame.inputs = out->inputs;
    if (want & ZD_MOVED) {
        zd_space_frame_place(self, &frame, p);
        zd_point_joints_turn(&self->point_joints, &frame);
    }
    if (is_moving(self, want)) zd_bodies_move(bodies, self->body, frame.pose, v, frame.twist);
    if (want & ZD_A) zd_bodies_write_A(bodies, self->body, p, out->A);
    if (want & ZD_M) zd_bodies_write_M(bodies, self->body, out->M);
    if (want & ZD_BIAS) zd_bodies_write_bias(bodies, self->body, v, out->d);
    if (want & ZD_POTENTIAL) *out->V = zd_space_potential(self, &frame);
    int status = want & ZD_FORCE ? write_force(self, &frame, t, out->f) : ZD_DONE;
    if (!status && (want & ZD_POWER)) status = zd_space_power(self, &frame, t, out->power);
    if (status) return status;
    if (want & ZD_C) zd_clear(self->packed.size_of_C, out->C);
    zd_point_joints_write(&self->point_joints, &frame, want, out);
    return want & ROWS && !self->point_joints.are_all ? zd_space_rows_write(self, &frame, want, t, out) : ZD_DONE;
}
