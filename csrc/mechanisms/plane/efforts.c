/* An effort is a force along a gauge: it acts with its value times the gauge's wrench on each body. */
#include "efforts.h"

#include "../common/laws.h"
#include "gauge.h"

int zd_plane_efforts_apply(const zd_plane *self, const zd_plane_frame *frame, double t)
{
    const zd_readings at = zd_plane_frame_readings(self, frame);
    for (int i = 0; i <= self->tree.bodies; i++)
        frame->wrench[i] = (zd_plane_wrench){zd_times(self->tree.link[i].mass, self->gravity), 0};
    for (const zd_effort *effort = self->elements.effort; effort < self->elements.effort + self->elements.efforts; effort++) {
        double value;
        if (zd_effort_say(&self->elements, &at, effort, t, &value, NULL)) return ZD_CALLBACK;
        const zd_plane_gauge *gauge = self->gauge + effort->gauge;
        zd_plane_reading reading = zd_plane_gauge_read(gauge, frame->pose);
        zd_plane_add_wrench(frame->wrench + gauge->first, value, reading.first);
        zd_plane_add_wrench(frame->wrench + gauge->second, value, reading.second);
    }
    return ZD_DONE;
}

int zd_plane_power(const zd_plane *self, const zd_plane_frame *frame, double t, double *power)
{
    const zd_readings at = zd_plane_frame_readings(self, frame);
    return zd_efforts_power(&self->elements, &at, t, power);
}

double zd_plane_potential(const zd_plane *self, const zd_plane_frame *frame)
{
    const zd_readings at = zd_plane_frame_readings(self, frame);
    double V = 0;
    for (int i = 1; i <= self->tree.bodies; i++)
        V -= self->tree.link[i].mass * zd_inner(self->gravity, frame->pose[i].at);
    return zd_springs_potential(&self->elements, &at, V);
}
