/* Magnitudes of ../common/magnitudes_of_dimension.h in joint coordinates. */
#include "links.h"

#include "../space/system/system.h"

static double norm(zd_vector3 a) { return sqrt(zd_inner3(a, a)); }

int zd_space_tree_magnitudes(const void *data, double t, const double *p, const double *v, double *magnitude, double *scratch)
{
    zd_space_frame frame;
    zd_space_frame_of(data, scratch, &frame);
    zd_space_frame_place(data, &frame, p);
    zd_space_frame_move(data, &frame, v);
    return zd_space_row_sizes(data, &frame, t, magnitude);
}

int zd_space_tree_force_magnitudes(const void *data, const double *inputs, double t, const double *p, const double *v, double *magnitude,
                                   double *scratch)
{
    const zd_space *self = data;
    const zd_space_tree *tree = zd_space_tree_of(self);
    zd_space_frame frame;
    zd_space_frame_of(self, scratch, &frame);
    frame.inputs = inputs;
    zd_space_frame_place(self, &frame, p);
    zd_space_frame_move(self, &frame, v);
    const int status = zd_space_force_sizes(self, &frame, t);
    for (int i = tree->bodies - 1; i >= 0; i--) {
        const int body = tree->order[i], parent = tree->link[body].inner;
        const double force = frame.wrench[body].force.x, torque = frame.wrench[body].torque.x;
        for (int k = tree->link[body].v; k < tree->link[body].v + tree->link[body].nv; k++)
            magnitude[k] = self->system.lengths[tree->nq + k] ? force : torque;
        frame.wrench[parent].force.x += force;
        frame.wrench[parent].torque.x += torque + norm(zd_minus3(frame.pose[body].at, frame.pose[parent].at)) * force;
    }
    return status;
}
