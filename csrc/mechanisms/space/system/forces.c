/* A generalized force along a marker quantity acts on each body with its value times the unit wrench of that quantity, as in the plane. */
#include "forces.h"

#include "../../common/laws.h"
#include "../marker_quantity.h"

int zd_space_forces_apply(const zd_space *self, const zd_space_frame *frame, double t)
{
    const zd_readings at = zd_space_frame_readings(self, frame);
    for (int i = 0; i <= self->bodies; i++)
        frame->wrench[i] = (zd_space_wrench){zd_times3(self->body[i].mass, self->gravity), {0, 0, 0}};
    for (const zd_generalized_force *force = self->elements.force; force < self->elements.force + self->elements.forces; force++) {
        double value;
        if (zd_force_evaluate(&self->elements, &at, force, t, &value, NULL)) return ZD_CALLBACK;
        const zd_space_quantity *quantity = self->quantity + force->quantity;
        const zd_space_reading reading = zd_space_quantity_read(quantity, frame->pose);
        zd_space_add_wrench(frame->wrench + quantity->first, value, reading.first);
        zd_space_add_wrench(frame->wrench + quantity->second, value, reading.second);
    }
    return ZD_DONE;
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
