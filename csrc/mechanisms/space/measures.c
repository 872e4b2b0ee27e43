/* Measures are gauges with their rates and accelerations, and what goes through joints, springs and drives, as in the plane. */
#include "measures.h"

#include "../common/output_spec.h"
#include "gauge.h"
#include "reactions.h"

enum { OF_FORCES = 3, OF_TORQUES = 3 };      /* components */

typedef struct state {
    double t;
    const double *v, *vdot, *lambda;
} state;

static void write_row(const zd_space *self, const zd_space_frame *frame, const zd_space_gauge *gauge, double scale, double *row)
{
    const zd_space_reading reading = zd_space_gauge_read(gauge, frame->pose);
    memset(row, 0, (size_t)self->system.nv * sizeof *row);
    if (self->carrying.act) {
        self->carrying.act(self, frame, gauge, scale, &reading, row);
        return;
    }
    const struct {
        int body;
        zd_space_wrench wrench;
    } sides[] = {{gauge->first, reading.first}, {gauge->second, reading.second}};
    for (int i = 0; i < 2; i++) {
        const int body = sides[i].body;
        if (body) zd_body_act(self->body + body, frame->pose + body, scale, sides[i].wrench, row + self->body[body].v);
    }
}

/* Component i of a measure that is a gauge, its rate, or the rate's rate. */
static void measure_gauge(const zd_space *self, const zd_space_frame *frame, const zd_output_spec *measure, int i, const state *at,
                          const zd_measured *out)
{
    const zd_space_gauge *gauge = self->gauge + measure->index + i;
    const int nv = self->system.nv, is_value = measure->quantity == ZD_VALUES, is_acceleration = measure->quantity == ZD_ACCELERATIONS;
    const double s = measure->scale;
    const double rate = !is_value || out->rate ? zd_space_gauge_rate(gauge, frame->pose, frame->twist) : 0;
    const double bias = is_acceleration || out->bias ? zd_space_gauge_bias_with(gauge, frame->pose, frame->twist, frame->bias) : 0;
    if (is_acceleration) {
        write_row(self, frame, gauge, s, frame->row);
        if (out->value) out->value[i] = s * bias + zd_dot(nv, frame->row, at->vdot);
        return;
    }
    if (out->value) out->value[i] = s * (is_value ? zd_space_gauge_value(gauge, frame->pose, frame->angle) : rate);
    if (out->rate && is_value) out->rate[i] = s * rate;
    if (out->row) write_row(self, frame, gauge, s, out->row + i * nv);
    if (out->bias) out->bias[i] = s * bias;
}

/* Finds the poses of the state, and the twists where the measure needs them, unless the call before has found them. */
static void place_and_move(const zd_space *self, const zd_space_frame *frame, const zd_output_spec *measure, const double *p, const double *v,
                   const zd_measured *out)
{
    if (!out->is_same_state) *frame->is_placed = *frame->is_moving = 0;
    if (*frame->is_placed == 0) zd_space_frame_place(self, frame, p);
    *frame->is_placed = 1;
    if (*frame->is_moving != 0 || (measure->quantity == ZD_VALUES && !out->rate && !out->bias)) return;
    zd_space_frame_move(self, frame, v);
    *frame->is_moving = 1;
}

/* The force of a joint between two points, positive where it pulls the second towards the first. */
static int measure_tension(const zd_space *self, const zd_space_frame *frame, int joint, const state *at, double *value)
{
    zd_space_wrench reaction;
    const int status = zd_space_joint_reaction(self, frame, joint, at->t, at->vdot, at->lambda, &reaction);
    const zd_space_joint *ends = self->joint + joint;
    const zd_vector3 apart = zd_minus3(zd_space_point_of(frame->pose + ends->second, ends->point2),
                                       zd_space_point_of(frame->pose + ends->first, ends->point1));
    *value = -zd_inner3(reaction.force, apart) / sqrt(zd_inner3(apart, apart));
    return status;
}

static void write_vector(zd_vector3 what, double *to)
{
    to[0] = what.x, to[1] = what.y, to[2] = what.z;
}

/* Force or moment on the second body of `size` efforts from measure->index on */
static int measure_efforts(const zd_space *self, const zd_space_frame *frame, const zd_output_spec *measure, const state *at, double *value)
{
    const zd_readings readings = zd_space_frame_readings(self, frame);
    zd_vector3 sum = {0, 0, 0};
    double effort;
    int status = ZD_DONE;
    for (int i = measure->index; i < measure->index + measure->size && !status; i++) {
        const zd_space_gauge *gauge = self->gauge + self->elements.effort[i].gauge;
        status = zd_effort_say(&self->elements, &readings, self->elements.effort + i, at->t, &effort, NULL);
        const zd_space_wrench what = zd_space_gauge_read(gauge, frame->pose).second;
        sum = zd_plus3(sum, zd_times3(effort, measure->quantity == ZD_EFFORT_FORCE ? what.force : what.torque));
    }
    write_vector(sum, value);
    return status;
}

static int measure_transmitted(const zd_space *self, const zd_space_frame *frame, const zd_output_spec *measure, const state *at,
                               double *value)
{
    const zd_readings readings = zd_space_frame_readings(self, frame);
    zd_space_wrench reaction;
    switch (measure->quantity) {
    case ZD_JOINT_TENSION: return measure_tension(self, frame, measure->index, at, value);
    case ZD_EFFORT_VALUE:
    case ZD_EFFORT_POWER: return zd_output_effort(&self->elements, &readings, measure, at->t, value);
    case ZD_EFFORT_FORCE:
    case ZD_EFFORT_TORQUE: return measure_efforts(self, frame, measure, at, value);
    case ZD_DRIVE_VALUE:
    case ZD_DRIVE_POWER: return zd_output_drive(&self->elements, &readings, measure, at->t, at->lambda, value);
    default: break;
    }
    const int status = zd_space_joint_reaction(self, frame, measure->index, at->t, at->vdot, at->lambda, &reaction);
    write_vector(measure->quantity == ZD_JOINT_TORQUE ? reaction.torque : reaction.force, value);
    return status;
}

static int evaluate(const void *data, int measure, double t, const double *p, const double *v, const double *vdot, const double *lambda,
                    const zd_measured *out, double *scratch)
{
    const zd_space *self = data;
    const zd_output_spec *output = self->elements.output + measure;
    const zd_space_frame frame = zd_space_frame_of(self, scratch);
    const state at = {t, v, vdot, lambda};
    if (!zd_output_is_available(&self->elements, output, vdot, lambda)) return ZD_BAD_ARGUMENT;
    place_and_move(self, &frame, output, p, v, out);
    if (output->quantity <= ZD_ACCELERATIONS) {
        for (int i = 0; i < output->size; i++) measure_gauge(self, &frame, output, i, &at, out);
        return ZD_DONE;
    }
    if (!out->value) return ZD_DONE;
    const int status = measure_transmitted(self, &frame, output, &at, out->value);
    for (int i = 0; i < zd_output_size(output, OF_FORCES, OF_TORQUES); i++) out->value[i] *= output->scale;
    return status;
}

static int act_on_body(const zd_space *self, const zd_space_frame *frame, int body, double scale, zd_space_wrench what, double *own)
{
    memset(own, 0, ZD_BODY_VELOCITIES * sizeof *own);
    if (!body) return -1;
    zd_body_act(self->body + body, frame->pose + body, scale, what, own);
    return self->body[body].v;
}

void zd_space_components(const zd_space *self, const double *p, const double *v, int count, const int *which, double *value, int *at,
                         double *row, double *scratch)
{
    const zd_space_frame frame = zd_space_frame_of(self, scratch);
    zd_space_frame_place(self, &frame, p);
    zd_space_frame_move(self, &frame, v);
    for (int i = 0; i < count; i++, row += 2 * ZD_BODY_VELOCITIES, at += 2) {
        const zd_output_spec *measure = self->elements.output + which[2 * i];
        const zd_space_gauge *gauge = self->gauge + measure->index + which[2 * i + 1];
        const zd_space_reading reading = zd_space_gauge_read(gauge, frame.pose);
        const int is_rate = measure->quantity == ZD_RATES;
        value[i] = measure->scale * (is_rate ? zd_space_gauge_rate(gauge, frame.pose, frame.twist)
                                             : zd_space_gauge_value(gauge, frame.pose, frame.angle));
        at[0] = act_on_body(self, &frame, gauge->first, measure->scale, reading.first, row);
        at[1] = act_on_body(self, &frame, gauge->second, measure->scale, reading.second, row + ZD_BODY_VELOCITIES);
    }
}

zd_measures zd_space_measures(const zd_space *self, zd_measure *measure)
{
    const int count = self->measures.count;
    zd_output_list(&self->elements, count, OF_FORCES, OF_TORQUES, measure);
    return (zd_measures){count, measure, zd_space_frame_size(self), evaluate};
}
