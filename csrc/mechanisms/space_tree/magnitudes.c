/* Magnitudes of the gradients of constraints and of generalized forces before cancellation, as in the plane (../plane/magnitudes.c). */
#include "links.h"

#include "../common/actions.h"
#include "../space/system/system.h"

static double norm(zd_vector3 a) { return sqrt(zd_inner3(a, a)); }

static double distance_of(const zd_space_pose *pose, const double *point) { return norm(pose->at) + norm(zd_vector3_of(point)); }

static void add(const zd_readings *at, void *to, int quantity, double factor)
{
    const zd_space *self = at->mechanism;
    const zd_space_pose *pose = ((const zd_space_frame *)at->frame)->pose;
    const zd_space_quantity *of = self->quantity + quantity;
    double *magnitude = to;
    const double size = fabs(factor);
    if (of->kind == ZD_SPACE_COSINE || of->kind == ZD_SPACE_ANGLE || of->kind == ZD_SPACE_ROTATION) {
        magnitude[1] += size;
        return;
    }
    const double lever = distance_of(pose + of->first, of->point1) + distance_of(pose + of->second, of->point2);
    magnitude[0] += size;
    magnitude[1] += size * (self->system.length + lever);
}

int zd_space_tree_magnitudes(const void *data, double t, const double *p, const double *v, double *magnitude, double *scratch)
{
    const zd_space *self = data;
    const zd_space_frame frame = zd_space_frame_of(self, scratch);
    const zd_readings readings = zd_space_frame_readings(self, &frame);
    const zd_actions actions = {&self->elements, &readings, add, NULL};
    zd_space_frame_place(self, &frame, p);
    zd_space_frame_move(self, &frame, v);
    return zd_rows_magnitudes(&actions, t, magnitude);
}

int zd_space_tree_force_magnitudes(const void *data, const double *inputs, double t, const double *p, const double *v, double *magnitude,
                                   double *scratch)
{
    const zd_space *self = data;
    const zd_space_tree *tree = zd_space_tree_of(self);
    zd_space_frame frame = zd_space_frame_of(self, scratch);
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
