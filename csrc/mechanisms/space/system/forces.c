/* A generalized force along a marker quantity acts on each body with its value times the unit wrench of that quantity, as in the plane. */
#include "system.h"

#include "../bodies.h"

ZD_INLINE void add(const zd_readings *at, void *unused, int index, double force)
{
    (void)unused;
    const zd_space *self = at->mechanism;
    const zd_space_frame *frame = at->frame;
    const zd_space_quantity *quantity = self->quantity + index;
    const zd_space_reading reading = zd_space_quantity_read(quantity, frame->pose);
    zd_space_add_wrench(frame->wrench + quantity->first, force, reading.first);
    zd_space_add_wrench(frame->wrench + quantity->second, force, reading.second);
}

void zd_space_add_force(const zd_readings *at, void *unused, int index, double force) { add(at, unused, index, force); }

int zd_space_forces_apply(const zd_space *self, const zd_space_frame *frame, double t)
{
    const zd_readings readings = zd_space_frame_readings(self, frame);
    const zd_actions actions = {&self->elements, &readings, add, NULL};
    for (int i = 0; i <= self->bodies; i++)
        frame->wrench[i] = (zd_space_wrench){zd_times3(self->body[i].mass, self->gravity), {0, 0, 0}};
    return zd_forces_act(&actions, t);
}

int zd_space_power(const zd_space *self, const zd_space_frame *frame, double t, double *power)
{
    const zd_readings at = zd_space_frame_readings(self, frame);
    return zd_forces_power(&self->elements, &at, t, power);
}

double zd_space_potential(const zd_space *self, const zd_space_frame *frame)
{
    const zd_readings at = zd_space_frame_readings(self, frame);
    double V = 0;
    for (int i = 1; i <= self->bodies; i++) V -= self->body[i].mass * zd_inner3(self->gravity, frame->pose[i].at);
    return zd_springs_potential(&self->elements, &at, V);
}
