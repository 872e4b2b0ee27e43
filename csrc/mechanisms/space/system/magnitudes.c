/* A force on a body has a moment with a lever arm as in the plane (../../plane/magnitudes.c). */
#include "system.h"

#include <string.h>

#include "../../common/actions.h"

static double norm(zd_vector3 a) { return sqrt(zd_inner3(a, a)); }

static void add_size(const zd_space *self, const zd_space_frame *frame, int body, double size, zd_space_wrench unit)
{
    const double force = size * norm(unit.force), lever = self->system.length + norm(frame->pose[body].at);
    frame->wrench[body].force.x += force;
    frame->wrench[body].torque.x += size * norm(unit.torque) + lever * force;
}

static void add_force(const zd_readings *at, void *unused, int index, double value)
{
    (void)unused;
    const zd_space *self = at->mechanism;
    const zd_space_frame *frame = at->frame;
    const zd_space_quantity *quantity = self->quantity + index;
    const zd_space_reading reading = zd_space_quantity_read(quantity, frame->pose);
    add_size(self, frame, quantity->first, fabs(value), reading.first);
    add_size(self, frame, quantity->second, fabs(value), reading.second);
}

int zd_space_force_sizes(const zd_space *self, const zd_space_frame *frame, double t)
{
    const zd_readings readings = zd_space_frame_readings(self, frame);
    const zd_actions actions = {&self->elements, &readings, add_force, NULL};
    memset(frame->wrench, 0, (size_t)(self->bodies + 1) * sizeof *frame->wrench);
    for (int i = 1; i <= self->bodies; i++)
        add_size(self, frame, i, self->body[i].mass, (zd_space_wrench){self->gravity, {0, 0, 0}});
    return zd_forces_act(&actions, t);
}

int zd_space_force_magnitudes(const void *data, const double *inputs, double t, const double *p, const double *v, double *magnitude,
                              double *scratch)
{
    const zd_space *self = data;
    zd_space_frame frame = zd_space_frame_of(self, scratch);
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
