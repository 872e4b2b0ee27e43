/* Measures are gauges with their rates and accelerations, and what goes through joints, springs and drives. */
#include "measures.h"

#include "../common/output_spec.h"
#include "gauge.h"
#include "reactions.h"

enum { OF_FORCES = 2, OF_TORQUES = 1 };      /* components */

typedef struct state {
    double t;
    const double *v, *vdot, *lambda;
} state;

static void write_row(const zd_plane *self, const zd_plane_frame *frame, const zd_plane_gauge *gauge, double scale, double *row)
{
    zd_plane_reading reading = zd_plane_gauge_read(gauge, frame->pose);
    memset(row, 0, (size_t)self->tree.nv * sizeof *row);
    zd_plane_tree_inward(&self->tree, frame->pose, gauge->first, scale, reading.first, row);
    zd_plane_tree_inward(&self->tree, frame->pose, gauge->second, scale, reading.second, row);
}

static int needs_twists(const zd_output_spec *measure, const zd_measured *out)
{
    return measure->quantity != ZD_VALUES || out->rate || out->bias;
}

/* Finds the poses of the state, and the twists where the measure needs them, unless the call before has found them. */
static void place_and_move(const zd_plane *self, const zd_plane_frame *frame, const zd_output_spec *measure, const double *p, const double *v,
                   const zd_measured *out)
{
    if (!out->is_same_state) *frame->is_placed = *frame->is_moving = 0;
    if (*frame->is_placed == 0) zd_plane_tree_turn(&self->tree, p, frame->sines);
    if (*frame->is_placed == 0) zd_plane_tree_place(&self->tree, p, frame->sines, frame->pose);
    *frame->is_placed = 1;
    if (*frame->is_moving != 0 || !needs_twists(measure, out)) return;
    zd_plane_tree_move(&self->tree, frame->pose, v, frame->twist);
    *frame->is_moving = 1;
}

/* Component i of a measure that is a gauge, its rate, or the rate's rate. */
static void measure_gauge(const zd_plane *self, const zd_plane_frame *frame, const zd_output_spec *measure, int i, const state *at,
                          const zd_measured *out)
{
    const zd_plane_gauge *gauge = self->gauge + measure->index + i;
    const double s = measure->scale;
    double bias = 0, rate = 0;
    if (needs_twists(measure, out)) rate = zd_plane_gauge_rate(gauge, frame->pose, frame->twist, &bias);
    if (measure->quantity == ZD_ACCELERATIONS) {
        write_row(self, frame, gauge, s, frame->row);
        if (out->value) out->value[i] = s * bias + zd_dot(self->tree.nv, frame->row, at->vdot);
        return;
    }
    if (out->value) out->value[i] = s * (measure->quantity == ZD_RATES ? rate : zd_plane_gauge_read(gauge, frame->pose).value);
    if (out->rate && measure->quantity == ZD_VALUES) out->rate[i] = s * rate;
    if (out->row) write_row(self, frame, gauge, s, out->row + i * self->tree.nv);
    if (out->bias) out->bias[i] = s * bias;
}

/* The force of a joint's first row along its gauge, positive where it pulls the second towards the first. */
static int measure_tension(const zd_plane *self, const zd_plane_frame *frame, int joint, const state *at, double *value)
{
    zd_plane_wrench reaction;
    int status = zd_plane_joint_reaction(self, frame, joint, at->t, at->vdot, at->lambda, &reaction);
    const zd_plane_joint *ends = self->joint + joint;
    zd_vector apart = zd_minus(zd_point_of(frame->pose + ends->second, ends->point2), zd_point_of(frame->pose + ends->first, ends->point1));
    *value = -zd_inner(reaction.force, apart) / sqrt(zd_inner(apart, apart));
    return status;
}

static int measure_effort_force(const zd_plane *self, const zd_plane_frame *frame, const zd_output_spec *measure, const state *at,
                                double *value)
{
    const zd_readings readings = zd_plane_frame_readings(self, frame);
    zd_vector force = {0, 0};
    double effort;
    int status = ZD_DONE;
    for (int i = measure->index; i < measure->index + measure->size && !status; i++) {
        const zd_plane_gauge *gauge = self->gauge + self->elements.effort[i].gauge;
        status = zd_effort_say(&self->elements, &readings, self->elements.effort + i, at->t, &effort, NULL);
        force = zd_plus(force, zd_times(effort, zd_plane_gauge_read(gauge, frame->pose).second.force));
    }
    value[0] = force.x, value[1] = force.y;
    return status;
}

static int measure_transmitted(const zd_plane *self, const zd_plane_frame *frame, const zd_output_spec *measure, const state *at,
                               double *value)
{
    const zd_readings readings = zd_plane_frame_readings(self, frame);
    zd_plane_wrench reaction;
    int status;
    switch (measure->quantity) {
    case ZD_JOINT_TENSION: return measure_tension(self, frame, measure->index, at, value);
    case ZD_EFFORT_VALUE:
    case ZD_EFFORT_POWER: return zd_output_effort(&self->elements, &readings, measure, at->t, value);
    case ZD_EFFORT_FORCE: return measure_effort_force(self, frame, measure, at, value);
    case ZD_DRIVE_VALUE:
    case ZD_DRIVE_POWER: return zd_output_drive(&self->elements, &readings, measure, at->t, at->lambda, value);
    default: status = zd_plane_joint_reaction(self, frame, measure->index, at->t, at->vdot, at->lambda, &reaction);
    }
    if (measure->quantity == ZD_JOINT_TORQUE) *value = reaction.torque;
    else value[0] = reaction.force.x, value[1] = reaction.force.y;
    return status;
}

static int evaluate(const void *data, int measure, double t, const double *p, const double *v, const double *vdot, const double *lambda,
                    const zd_measured *out, double *scratch)
{
    const zd_plane *self = data;
    const zd_output_spec *output = self->elements.output + measure;
    const zd_plane_frame frame = zd_plane_frame_of(self, scratch);
    const state at = {t, v, vdot, lambda};
    if (!zd_output_is_available(&self->elements, output, vdot, lambda)) return ZD_BAD_ARGUMENT;
    place_and_move(self, &frame, output, p, v, out);
    if (output->quantity <= ZD_ACCELERATIONS) {
        for (int i = 0; i < output->size; i++) measure_gauge(self, &frame, output, i, &at, out);
        return ZD_DONE;
    }
    if (!out->value) return ZD_DONE;
    int status = measure_transmitted(self, &frame, output, &at, out->value);
    for (int i = 0; i < zd_output_size(output, OF_FORCES, OF_TORQUES); i++) out->value[i] *= output->scale;
    return status;
}

static int act_on_body(const zd_plane *self, int body, double scale, zd_plane_wrench what, double *own)
{
    memset(own, 0, 3 * sizeof *own);
    if (!body) return -1;
    zd_plane_tree_act_on_free(self->tree.link + body, scale, what, own);
    return self->tree.link[body].coordinate;
}

void zd_plane_components(const zd_plane *self, const double *p, const double *v, int count, const int *which, double *value,
                             int *at, double *row, double *scratch)
{
    const zd_plane_frame frame = zd_plane_frame_of(self, scratch);
    zd_plane_tree_turn(&self->tree, p, frame.sines);
    zd_plane_tree_place(&self->tree, p, frame.sines, frame.pose);
    zd_plane_tree_move(&self->tree, frame.pose, v, frame.twist);
    for (int i = 0; i < count; i++) {
        const zd_output_spec *measure = self->elements.output + which[2 * i];
        const zd_plane_gauge *gauge = self->gauge + measure->index + which[2 * i + 1];
        const zd_plane_reading reading = zd_plane_gauge_read(gauge, frame.pose);
        double bias;
        const double rate = zd_plane_gauge_rate(gauge, frame.pose, frame.twist, &bias);
        value[i] = measure->scale * (measure->quantity == ZD_RATES ? rate : reading.value);
        at[2 * i] = act_on_body(self, gauge->first, measure->scale, reading.first, row + 6 * i);
        at[2 * i + 1] = act_on_body(self, gauge->second, measure->scale, reading.second, row + 6 * i + 3);
    }
}

zd_measures zd_plane_measures(const zd_plane *self, zd_measure *measure)
{
    const int count = self->measures.count;
    zd_output_list(&self->elements, count, OF_FORCES, OF_TORQUES, measure);
    return (zd_measures){count, measure, self->system.scratch, evaluate};
}
