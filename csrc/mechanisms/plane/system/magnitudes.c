#include "system.h"

#include <string.h>

#include "../../../linalg/roots.h"
#include "../tree.h"

#define MECHANISM zd_plane
#define OF(name) zd_plane_##name
#define VECTOR_OF(x) (zd_vector){(x)[0], (x)[1]}
#define TORQUE(wrench) (wrench).torque

static double norm(zd_vector a) { return zd_hypotenuse(a.x, a.y); }
static double size_of_torque(zd_plane_wrench wrench) { return fabs(wrench.torque); }
static int is_angular(int kind) { return kind == ZD_PLANE_ANGLE; }

#include "../../common/magnitudes_of_dimension.h"

static zd_plane_frame placed(const zd_plane *self, const double *p, const double *v, double *scratch)
{
    zd_plane_frame frame;
    zd_plane_frame_of(self, scratch, &frame);
    zd_plane_tree_turn(&self->tree, p, frame.sines);
    zd_plane_tree_place(&self->tree, p, frame.sines, frame.pose);
    zd_plane_tree_move(&self->tree, frame.pose, v, frame.twist);
    return frame;
}

int zd_plane_magnitudes(const void *data, double t, const double *p, const double *v, double *magnitude, double *scratch)
{
    const zd_plane_frame frame = placed(data, p, v, scratch);
    return zd_plane_row_sizes(data, &frame, t, magnitude);
}

/* Sizes on each body reach its parent, too, with the distance between both as lever arm. */
static void pass_inward(const zd_plane *self, const zd_plane_frame *frame)
{
    for (int i = self->tree.bodies; i; i--) {
        const int parent = self->tree.link[i].inner;
        const zd_plane_wrench *outer = frame->wrench + i;
        frame->wrench[parent].force.x += outer->force.x;
        frame->wrench[parent].torque += outer->torque + norm(zd_minus(frame->pose[i].at, frame->pose[parent].at)) * outer->force.x;
    }
}

int zd_plane_force_magnitudes(const void *data, const double *inputs, double t, const double *p, const double *v, double *magnitude,
                              double *scratch)
{
    const zd_plane *self = data;
    zd_plane_frame frame = placed(self, p, v, scratch);
    frame.inputs = inputs;
    const int status = zd_plane_force_sizes(self, &frame, t);
    pass_inward(self, &frame);
    for (int k = 0; k < self->tree.nv; k++) {
        const zd_plane_wrench *on = frame.wrench + self->coordinate[k].body;
        magnitude[k] = self->system.lengths[k] ? on->force.x : on->torque;
    }
    return status;
}
