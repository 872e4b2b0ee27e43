/* An effort is a force along a gauge, as in the plane: its value times the gauge's wrench on each body, and its power is value times rate. */
#include "efforts.h"

#include "gauge.h"

static double rate_of(const zd_space *self, const zd_frame3 *frame, int gauge)
{
    return zd_space_gauge_rate(self->gauge + gauge, frame->pose, frame->twist);
}

static double value_of(const zd_space *self, const zd_frame3 *frame, int gauge)
{
    return zd_space_gauge_read(self->gauge + gauge, frame->pose).value;
}

static int ask_law(const zd_space *self, const zd_frame3 *frame, const zd_effort *effort, double t, double *value)
{
    for (int i = 0; i < effort->terms; i++) {
        const int gauge = self->term[effort->first + i].gauge;
        frame->x[i] = value_of(self, frame, gauge);
        frame->xdot[i] = rate_of(self, frame, gauge);
    }
    if (self->law(self->owner, effort->law, t, frame->x, frame->xdot, frame->out)) return ZD_CALLBACK;
    *value = frame->out[0];
    return ZD_DONE;
}

int zd_space_effort_value(const zd_space *self, const zd_frame3 *frame, const zd_effort *effort, double t, double *value, double *rate)
{
    const double speed = rate || effort->damping != 0 ? rate_of(self, frame, effort->gauge) : 0;
    if (rate) *rate = speed;
    *value = effort->value;
    if (effort->kind == ZD_EFFORT_LAW) return ask_law(self, frame, effort, t, value);
    if (effort->kind == ZD_EFFORT_SPRING) *value = -effort->stiffness * value_of(self, frame, effort->gauge) - effort->damping * speed;
    return ZD_DONE;
}

int zd_space_efforts_apply(const zd_space *self, const zd_frame3 *frame, double t)
{
    for (int i = 0; i <= self->bodies; i++)
        frame->wrench[i] = (zd_wrench3){zd_times3(self->body[i].mass, self->gravity), {0, 0, 0}};
    for (const zd_effort *effort = self->effort; effort < self->effort + self->efforts; effort++) {
        double value;
        if (zd_space_effort_value(self, frame, effort, t, &value, NULL)) return ZD_CALLBACK;
        const zd_space_gauge *gauge = self->gauge + effort->gauge;
        const zd_reading3 reading = zd_space_gauge_read(gauge, frame->pose);
        zd_add_wrench3(frame->wrench + gauge->first, value, reading.first);
        zd_add_wrench3(frame->wrench + gauge->second, value, reading.second);
    }
    return ZD_DONE;
}

int zd_space_efforts_power(const zd_space *self, const zd_frame3 *frame, double t, double *power)
{
    *power = 0;
    for (const zd_effort *effort = self->effort; effort < self->effort + self->efforts; effort++) {
        double value, rate;
        if (effort->kind == ZD_EFFORT_SPRING) {
            if (effort->damping == 0) continue;
            rate = rate_of(self, frame, effort->gauge);
            value = -effort->damping * rate;
        } else if (zd_space_effort_value(self, frame, effort, t, &value, &rate)) {
            return ZD_CALLBACK;
        }
        *power += value * rate;
    }
    return ZD_DONE;
}

double zd_space_efforts_potential(const zd_space *self, const zd_frame3 *frame)
{
    double V = 0;
    for (int i = 1; i <= self->bodies; i++) V -= self->body[i].mass * zd_inner3(self->gravity, frame->pose[i].at);
    for (const zd_effort *effort = self->effort; effort < self->effort + self->efforts; effort++) {
        if (effort->kind != ZD_EFFORT_SPRING || effort->stiffness == 0) continue;
        const double x = value_of(self, frame, effort->gauge);
        V += 0.5 * effort->stiffness * x * x;
    }
    return V;
}
