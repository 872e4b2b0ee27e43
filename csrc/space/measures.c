/* Measures are gauges with their rates and accelerations, and what goes through joints, springs and drives, as in the plane. */
#include "measures.h"

#include "efforts.h"
#include "gauge.h"
#include "reactions.h"

typedef struct state {
    double t;
    const double *v, *vdot, *lambda;
} state;

static int size_of(const zd_observed *measure)
{
    if (measure->quantity <= ZD_ACCELERATIONS) return measure->size;
    return measure->quantity == ZD_JOINT_FORCE || measure->quantity == ZD_JOINT_TORQUE ? 3 : 1;
}

static enum zd_depends depends_on(const zd_observed *measure)
{
    return measure->quantity == ZD_VALUES ? ZD_OF_POSITIONS : measure->quantity == ZD_RATES ? ZD_OF_VELOCITIES : ZD_OF_ACCELERATIONS;
}

static void write_row(const zd_space *self, const zd_frame3 *frame, const zd_space_gauge *gauge, double scale, double *row)
{
    const zd_reading3 reading = zd_space_gauge_read(gauge, frame->pose);
    memset(row, 0, (size_t)self->system.nv * sizeof *row);
    const struct {
        int body;
        zd_wrench3 wrench;
    } sides[] = {{gauge->first, reading.first}, {gauge->second, reading.second}};
    for (int i = 0; i < 2; i++) {
        const int body = sides[i].body;
        if (body) zd_body_act(self->body + body, frame->pose + body, scale, sides[i].wrench, row + self->body[body].v);
    }
}

/* Component i of a measure that is a gauge, its rate, or the rate's rate. */
static void measure_gauge(const zd_space *self, const zd_frame3 *frame, const zd_observed *measure, int i, const state *at,
                          const zd_measured *out)
{
    const zd_space_gauge *gauge = self->gauge + measure->index + i;
    const int nv = self->system.nv;
    const double rate = zd_space_gauge_rate(gauge, frame->pose, frame->twist), s = measure->scale;
    const double bias = zd_space_gauge_bias(gauge, frame->pose, frame->twist);
    if (measure->quantity == ZD_ACCELERATIONS) {
        write_row(self, frame, gauge, s, frame->row);
        if (out->value) out->value[i] = s * bias + zd_dot(nv, frame->row, at->vdot);
        return;
    }
    if (out->value) out->value[i] = s * (measure->quantity == ZD_RATES ? rate : zd_space_gauge_read(gauge, frame->pose).value);
    if (out->rate && measure->quantity == ZD_VALUES) out->rate[i] = s * rate;
    if (out->row) write_row(self, frame, gauge, s, out->row + i * nv);
    if (out->bias) out->bias[i] = s * bias;
}

/* The force of a joint between two points, positive where it pulls the second towards the first. */
static int measure_tension(const zd_space *self, const zd_frame3 *frame, int joint, const state *at, double *value)
{
    zd_wrench3 reaction;
    const int status = zd_space_joint_reaction(self, frame, joint, at->t, at->lambda, &reaction);
    const zd_space_joint *ends = self->joint + joint;
    const zd_vector3 apart = zd_minus3(zd_point3_of(frame->pose + ends->second, ends->point2), zd_point3_of(frame->pose + ends->first, ends->point1));
    *value = -zd_inner3(reaction.force, apart) / sqrt(zd_inner3(apart, apart));
    return status;
}

static int measure_effort(const zd_space *self, const zd_frame3 *frame, const zd_observed *measure, const state *at, double *value)
{
    double rate;
    const int status = zd_space_effort_value(self, frame, self->effort + measure->index, at->t, value, &rate);
    if (measure->quantity == ZD_EFFORT_POWER) *value *= rate;
    return status;
}

static void write_vector(zd_vector3 what, double *to)
{
    to[0] = what.x, to[1] = what.y, to[2] = what.z;
}

static int measure_drive(const zd_space *self, const zd_frame3 *frame, const zd_observed *measure, const state *at, double *value)
{
    const int status = zd_space_drive_effort(self, frame, measure->index, measure->term, at->t, at->lambda, value);
    const zd_relation *row = self->row + self->row_of_relation[measure->index];
    if (measure->quantity == ZD_DRIVE_POWER)
        *value *= zd_space_gauge_rate(self->gauge + self->term[row->first].gauge, frame->pose, frame->twist);
    return status;
}

static int measure_transmitted(const zd_space *self, const zd_frame3 *frame, const zd_observed *measure, const state *at, double *value)
{
    zd_wrench3 reaction;
    switch (measure->quantity) {
    case ZD_JOINT_TENSION: return measure_tension(self, frame, measure->index, at, value);
    case ZD_EFFORT_VALUE:
    case ZD_EFFORT_POWER: return measure_effort(self, frame, measure, at, value);
    case ZD_DRIVE_VALUE:
    case ZD_DRIVE_POWER: return measure_drive(self, frame, measure, at, value);
    default: break;
    }
    const int status = zd_space_joint_reaction(self, frame, measure->index, at->t, at->lambda, &reaction);
    write_vector(measure->quantity == ZD_JOINT_TORQUE ? reaction.torque : reaction.force, value);
    return status;
}

static int has_what_it_needs(const zd_space *self, const zd_observed *measure, const state *at)
{
    const int quantity = measure->quantity, is_effort = quantity == ZD_EFFORT_VALUE || quantity == ZD_EFFORT_POWER;
    if (quantity <= ZD_RATES || is_effort) return 1;
    return at->vdot && (quantity == ZD_ACCELERATIONS || at->lambda || self->m == 0);
}

static int evaluate(const void *data, int measure, double t, const double *p, const double *v, const double *vdot, const double *lambda,
                    const zd_measured *out, double *scratch)
{
    const zd_space *self = data;
    const zd_observed *observed = self->observed + measure;
    const zd_frame3 frame = zd_frame3_of(self, scratch);
    const state at = {t, v, vdot, lambda};
    if (!has_what_it_needs(self, observed, &at)) return ZD_BAD_ARGUMENT;
    zd_bodies_place(self->bodies, self->body, p, frame.pose);
    zd_bodies_move(self->bodies, self->body, frame.pose, v, frame.twist);
    if (observed->quantity <= ZD_ACCELERATIONS) {
        for (int i = 0; i < observed->size; i++) measure_gauge(self, &frame, observed, i, &at, out);
        return ZD_DONE;
    }
    if (!out->value) return ZD_DONE;
    const int status = measure_transmitted(self, &frame, observed, &at, out->value);
    for (int i = 0; i < size_of(observed); i++) out->value[i] *= observed->scale;
    return status;
}

zd_measures zd_space_measures(const zd_space *self, zd_measure *measure)
{
    const int count = self->measures.count;
    for (int i = 0; i < count; i++) {
        const zd_observed *observed = self->observed + i;
        measure[i] = (zd_measure){observed->name, observed->unit, size_of(observed), depends_on(observed)};
    }
    return (zd_measures){count, measure, zd_frame3_size(self), evaluate};
}
