/* A generalized force along a marker quantity acts on each body with its value times the unit wrench of that quantity. */
#include "system.h"

#include "../tree.h"

ZD_INLINE void add(const zd_readings *at, void *unused, int index, double force)
{
    (void)unused;
    const zd_plane *self = at->mechanism;
    const zd_plane_frame *frame = at->frame;
    const zd_plane_quantity *quantity = self->quantity + index;
    const zd_plane_reading reading = zd_plane_quantity_read(quantity, frame->pose);
    zd_plane_add_wrench(frame->wrench + quantity->first, force, reading.first);
    zd_plane_add_wrench(frame->wrench + quantity->second, force, reading.second);
}

void zd_plane_add_force(const zd_readings *at, void *unused, int index, double force) { add(at, unused, index, force); }

int zd_plane_forces_apply(const zd_plane *self, const zd_plane_frame *frame, double t)
{
    const zd_readings readings = zd_plane_frame_readings(self, frame);
    const zd_actions actions = {&self->elements, &readings, add, NULL};
    for (int i = 0; i <= self->tree.bodies; i++)
        frame->wrench[i] = (zd_plane_wrench){zd_times(self->tree.link[i].mass, self->gravity), 0};
    return zd_forces_act(&actions, t);
}

int zd_plane_power(const zd_plane *self, const zd_plane_frame *frame, double t, double *power)
{
    const zd_readings at = zd_plane_frame_readings(self, frame);
    return zd_forces_power(&self->elements, &at, t, power);
}

double zd_plane_potential(const zd_plane *self, const zd_plane_frame *frame)
{
    const zd_readings at = zd_plane_frame_readings(self, frame);
    double V = 0;
    for (int i = 1; i <= self->tree.bodies; i++)
        V -= self->tree.link[i].mass * zd_inner(self->gravity, frame->pose[i].at);
    return zd_springs_potential(&self->elements, &at, V);
}
