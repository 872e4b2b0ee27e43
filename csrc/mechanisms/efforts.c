/* An effort is a force along a gauge: it acts with its value times the gauge's wrench on each body, and its power is value times rate. */
#include "efforts.h"

#include "gauge.h"

static double rate_of(const zd_mechanism *self, const zd_frame *frame, int gauge)
{
    double bias;
    return zd_gauge_rate(self->gauge + gauge, frame->pose, frame->twist, &bias);
}

static int ask_law(const zd_mechanism *self, const zd_frame *frame, const zd_effort *effort, double t, double *value)
{
    for (int i = 0; i < effort->terms; i++) {
        int gauge = self->term[effort->first + i].gauge;
        frame->x[i] = zd_gauge_read(self->gauge + gauge, frame->pose).value;
        frame->xdot[i] = rate_of(self, frame, gauge);
    }
    if (self->law(self->owner, effort->law, t, frame->x, frame->xdot, frame->out)) return ZD_CALLBACK;
    *value = frame->out[0];
    return ZD_DONE;
}

int zd_effort_value(const zd_mechanism *self, const zd_frame *frame, const zd_effort *effort, double t, double *value, double *rate)
{
    double speed = rate || effort->damping != 0 ? rate_of(self, frame, effort->gauge) : 0;
    if (rate) *rate = speed;
    *value = effort->value;
    if (effort->kind == ZD_EFFORT_LAW) return ask_law(self, frame, effort, t, value);
    if (effort->kind == ZD_EFFORT_SPRING)
        *value = -effort->stiffness * zd_gauge_read(self->gauge + effort->gauge, frame->pose).value - effort->damping * speed;
    return ZD_DONE;
}

int zd_efforts_apply(const zd_mechanism *self, const zd_frame *frame, double t)
{
    for (int i = 0; i <= self->tree.bodies; i++)
        frame->wrench[i] = (zd_wrench){zd_times(self->tree.link[i].mass, self->gravity), 0};
    for (const zd_effort *effort = self->effort; effort < self->effort + self->efforts; effort++) {
        double value;
        if (zd_effort_value(self, frame, effort, t, &value, NULL)) return ZD_CALLBACK;
        const zd_gauge *gauge = self->gauge + effort->gauge;
        zd_reading reading = zd_gauge_read(gauge, frame->pose);
        zd_add_wrench(frame->wrench + gauge->first, value, reading.first);
        zd_add_wrench(frame->wrench + gauge->second, value, reading.second);
    }
    return ZD_DONE;
}

int zd_efforts_power(const zd_mechanism *self, const zd_frame *frame, double t, double *power)
{
    *power = 0;
    for (const zd_effort *effort = self->effort; effort < self->effort + self->efforts; effort++) {
        double value, rate;
        if (effort->kind == ZD_EFFORT_SPRING) {
            if (effort->damping == 0) continue;
            rate = rate_of(self, frame, effort->gauge);
            value = -effort->damping * rate;
        } else if (zd_effort_value(self, frame, effort, t, &value, &rate)) {
            return ZD_CALLBACK;
        }
        *power += value * rate;
    }
    return ZD_DONE;
}

double zd_efforts_potential(const zd_mechanism *self, const zd_frame *frame)
{
    double V = 0;
    for (int i = 1; i <= self->tree.bodies; i++)
        V -= self->tree.link[i].mass * zd_inner(self->gravity, frame->pose[i].at);
    for (const zd_effort *effort = self->effort; effort < self->effort + self->efforts; effort++) {
        if (effort->kind != ZD_EFFORT_SPRING || effort->stiffness == 0) continue;
        double x = zd_gauge_read(self->gauge + effort->gauge, frame->pose).value;
        V += 0.5 * effort->stiffness * x * x;
    }
    return V;
}
