/* An effort is a force along a gauge, as in the plane: it acts with its value times the gauge's wrench on each body. */
#include "efforts.h"

#include "../common/laws.h"
#include "gauge.h"

int zd_space_efforts_apply(const zd_space *self, const zd_space_frame *frame, double t)
{
    const zd_readings at = zd_space_frame_readings(self, frame);
    for (int i = 0; i <= self->bodies; i++)
        frame->wrench[i] = (zd_space_wrench){zd_times3(self->body[i].mass, self->gravity), {0, 0, 0}};
    for (const zd_effort *effort = self->elements.effort; effort < self->elements.effort + self->elements.efforts; effort++) {
        double value;
        if (zd_effort_say(&self->elements, &at, effort, t, &value, NULL)) return ZD_CALLBACK;
        const zd_space_gauge *gauge = self->gauge + effort->gauge;
        const zd_space_reading reading = zd_space_gauge_read(gauge, frame->pose);
        zd_space_add_wrench(frame->wrench + gauge->first, value, reading.first);
        zd_space_add_wrench(frame->wrench + gauge->second, value, reading.second);
    }
    return ZD_DONE;
}

int zd_space_power(const zd_space *self, const zd_space_frame *frame, double t, double *power)
{
    const zd_readings at = zd_space_frame_readings(self, frame);
    return zd_efforts_power(&self->elements, &at, t, power);
}

double zd_space_potential(const zd_space *self, const zd_space_frame *frame)
{
    const zd_readings at = zd_space_frame_readings(self, frame);
    double V = 0;
    for (int i = 1; i <= self->bodies; i++) V -= self->body[i].mass * zd_inner3(self->gravity, frame->pose[i].at);
    return zd_springs_potential(&self->elements, &at, V);
}
