/* Numerics of measures in the plane: see ../../common/output_spec.h. */
#include "system.h"

#include "../../common/output_spec.h"
#include "../tree.h"

static void place(const void *mechanism, const void *frame, const double *p)
{
    const zd_plane *self = mechanism;
    const zd_plane_frame *at = frame;
    zd_plane_tree_turn(&self->tree, p, at->sines);
    zd_plane_tree_place(&self->tree, p, at->sines, at->pose);
}

static void move(const void *mechanism, const void *frame, const double *v)
{
    const zd_plane *self = mechanism;
    const zd_plane_frame *at = frame;
    zd_plane_tree_move(&self->tree, at->pose, v, at->twist);
}

static void write_row(const void *mechanism, const void *frame, int index, double scale, double *row)
{
    const zd_plane *self = mechanism;
    const zd_plane_frame *at = frame;
    const zd_plane_quantity *quantity = self->quantity + index;
    const zd_plane_reading reading = zd_plane_quantity_read(quantity, at->pose);
    memset(row, 0, (size_t)self->tree.nv * sizeof *row);
    zd_plane_tree_inward(&self->tree, at->pose, quantity->first, scale, reading.first, row);
    zd_plane_tree_inward(&self->tree, at->pose, quantity->second, scale, reading.second, row);
}

static void write_wrench(zd_plane_wrench from, double *to)
{
    to[0] = from.force.x, to[1] = from.force.y, to[ZD_WRENCH_FORCE] = from.torque;
}

static void unit_wrench(const void *mechanism, const void *frame, int quantity, double *wrench)
{
    const zd_plane *self = mechanism;
    const zd_plane_frame *at = frame;
    write_wrench(zd_plane_quantity_read(self->quantity + quantity, at->pose).second, wrench);
}

static void unit_wrenches(const void *mechanism, const void *frame, int index, int *body, double *wrench)
{
    const zd_plane_quantity *quantity = ((const zd_plane *)mechanism)->quantity + index;
    const zd_plane_reading reading = zd_plane_quantity_read(quantity, ((const zd_plane_frame *)frame)->pose);
    body[0] = quantity->first, body[1] = quantity->second;
    memset(wrench, 0, 2 * ZD_WRENCH_SIZE * sizeof *wrench);
    write_wrench(reading.first, wrench);
    write_wrench(reading.second, wrench + ZD_WRENCH_SIZE);
}

static int reaction_of(const void *mechanism, const void *frame, int joint, const zd_measured_state *at, double *wrench)
{
    zd_plane_wrench reaction;
    const int status = zd_plane_joint_reaction(mechanism, frame, joint, at, &reaction);
    write_wrench(reaction, wrench);
    return status;
}

static void apart_of(const void *mechanism, const void *frame, int joint, double *vector)
{
    const zd_plane_joint *ends = ((const zd_plane *)mechanism)->joint + joint;
    const zd_plane_pose *pose = ((const zd_plane_frame *)frame)->pose;
    const zd_vector apart = zd_minus(zd_point_of(pose + ends->second, ends->point2), zd_point_of(pose + ends->first, ends->point1));
    vector[0] = apart.x, vector[1] = apart.y;
}

static const zd_measure_numerics NUMERICS = {2, 1, place, move, zd_plane_bias, write_row, unit_wrench, unit_wrenches, reaction_of, apart_of};

static zd_measuring measuring_of(const zd_plane *self, const zd_plane_frame *frame)
{
    return (zd_measuring){
        .numerics = &NUMERICS, .elements = &self->elements, .readings = zd_plane_frame_readings(self, frame), .nv = self->tree.nv,
        .joints = self->joints, .is_placed = frame->is_placed, .is_moving = frame->is_moving, .is_least = frame->is_least,
        .least = frame->least, .row = frame->row};
}

static int evaluate(const void *data, const double *inputs, int measure, double t, const double *p, const double *v, const double *vdot,
                    const double *lambda, const zd_measured *out, double *scratch)
{
    const zd_plane *self = data;
    zd_plane_frame frame = zd_plane_frame_of(self, scratch);
    frame.inputs = inputs;
    const zd_measuring measuring = measuring_of(self, &frame);
    return zd_measures_evaluate(&measuring, measure, &(zd_measured_state){t, p, v, vdot, lambda, 0}, out);
}

int zd_plane_read(const void *data, int law, double t, const double *p, const double *v, const double *r, int is_same_state, double *u,
                  double *scratch)
{
    const zd_plane *self = data;
    const zd_plane_frame frame = zd_plane_frame_of(self, scratch);
    const zd_measuring measuring = measuring_of(self, &frame);
    return zd_measures_read(&measuring, law, &(zd_measured_state){t, p, v, NULL, NULL, 0}, r, is_same_state, u);
}

static int act_on_body(const zd_plane *self, int body, double scale, zd_plane_wrench what, double *own)
{
    memset(own, 0, 3 * sizeof *own);
    if (!body) return -1;
    zd_plane_tree_act_on_free(self->tree.link + body, scale, what, own);
    return self->tree.link[body].coordinate;
}

void zd_plane_components(const void *mechanism, const double *p, const double *v, int count, const int *which, double *value,
                             int *at, double *row, double *scratch)
{
    const zd_plane *self = mechanism;
    const zd_plane_frame frame = zd_plane_frame_of(self, scratch);
    zd_plane_tree_turn(&self->tree, p, frame.sines);
    zd_plane_tree_place(&self->tree, p, frame.sines, frame.pose);
    zd_plane_tree_move(&self->tree, frame.pose, v, frame.twist);
    for (int i = 0; i < count; i++) {
        const zd_output_spec *measure = self->elements.output + which[2 * i];
        const zd_plane_quantity *quantity = self->quantity + measure->index + which[2 * i + 1];
        const zd_plane_reading reading = zd_plane_quantity_read(quantity, frame.pose);
        double bias;
        const double rate = zd_plane_quantity_rate(quantity, frame.pose, frame.twist, &bias);
        value[i] = measure->scale * (measure->kind == ZD_RATES ? rate : reading.value);
        at[2 * i] = act_on_body(self, quantity->first, measure->scale, reading.first, row + 6 * i);
        at[2 * i + 1] = act_on_body(self, quantity->second, measure->scale, reading.second, row + 6 * i + 3);
    }
}

zd_measures zd_plane_measures(const zd_plane *self, zd_measure *measure)
{
    const int count = self->measures.count;
    zd_output_list(&self->elements, count, NUMERICS.forces, NUMERICS.torques, measure);
    return (zd_measures){count, measure, self->system.scratch, evaluate};
}
