#include "system.h"

#include <string.h>

#define MECHANISM zd_space
#define OF(name) zd_space_##name
#define VECTOR_OF(x) zd_vector3_of(x)
#define TORQUE(wrench) (wrench).torque.x

static double norm(zd_vector3 a) { return sqrt(zd_inner3(a, a)); }
static double size_of_torque(zd_space_wrench wrench) { return norm(wrench.torque); }
static int is_angular(int kind) { return kind == ZD_SPACE_COSINE || kind == ZD_SPACE_ANGLE || kind == ZD_SPACE_ROTATION; }

#include "../../common/magnitudes_of_dimension.h"

int zd_space_force_magnitudes(const void *data, const double *inputs, double t, const double *p, const double *v, double *magnitude,
                              double *scratch)
{
    const zd_space *self = data;
    zd_space_frame frame;
    zd_space_frame_of(self, scratch, &frame);
    frame.inputs = inputs;
    zd_space_frame_place(self, &frame, p);
    zd_space_frame_move(self, &frame, v);
    const int status = zd_space_force_sizes(self, &frame, t);
    for (int i = 1; i <= self->bodies; i++) {
        double *own = magnitude + self->body[i].v;
        for (int k = 0; k < (self->body[i].turns ? ZD_BODY_VELOCITIES : ZD_POINT_COORDINATES); k++)
            own[k] = k < ZD_POINT_COORDINATES ? frame.wrench[i].force.x : frame.wrench[i].torque.x;
    }
    return status;
}
