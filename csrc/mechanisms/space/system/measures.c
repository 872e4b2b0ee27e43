/* Numerics of measures in space: see ../../common/output_spec.h. */
#include "system.h"

#include "../../common/output_spec.h"
#include "../bodies.h"

static void place(const void *mechanism, const void *frame, const double *p) { zd_space_frame_place(mechanism, frame, p); }

static void move(const void *mechanism, const void *frame, const double *v) { zd_space_frame_move(mechanism, frame, v); }

static void write_row(const void *mechanism, const void *frame, int index, double scale, double *row)
{
    const zd_space *self = mechanism;
    const zd_space_frame *at = frame;
    const zd_space_quantity *quantity = self->quantity + index;
    const zd_space_reading reading = zd_space_quantity_read(quantity, at->pose);
    memset(row, 0, (size_t)self->system.nv * sizeof *row);
    if (self->carrying.act) {
        self->carrying.act(self, at, quantity, scale, &reading, row);
        return;
    }
    const struct {
        int body;
        zd_space_wrench wrench;
    } sides[] = {{quantity->first, reading.first}, {quantity->second, reading.second}};
    for (int i = 0; i < 2; i++) {
        const int body = sides[i].body;
        if (body) zd_body_act(self->body + body, at->pose + body, scale, sides[i].wrench, row + self->body[body].v);
    }
}

static void write_vector(zd_vector3 what, double *to)
{
    to[0] = what.x, to[1] = what.y, to[2] = what.z;
}

static void write_wrench(zd_space_wrench from, double *to)
{
    write_vector(from.force, to);
    write_vector(from.torque, to + ZD_WRENCH_FORCE);
}

static void unit_wrench(const void *mechanism, const void *frame, int quantity, double *wrench)
{
    const zd_space *self = mechanism;
    const zd_space_frame *at = frame;
    write_wrench(zd_space_quantity_read(self->quantity + quantity, at->pose).second, wrench);
}

static void unit_wrenches(const void *mechanism, const void *frame, int index, int *body, double *wrench)
{
    const zd_space_quantity *quantity = ((const zd_space *)mechanism)->quantity + index;
    const zd_space_reading reading = zd_space_quantity_read(quantity, ((const zd_space_frame *)frame)->pose);
    body[0] = quantity->first, body[1] = quantity->second;
    write_wrench(reading.first, wrench);
    write_wrench(reading.second, wrench + ZD_WRENCH_SIZE);
}

static int reaction_of(const void *mechanism, const void *frame, int joint, const zd_measured_state *at, double *wrench)
{
    zd_space_wrench reaction;
    const int status = zd_space_joint_reaction(mechanism, frame, joint, at, &reaction);
    write_wrench(reaction, wrench);
    return status;
}

static void apart_of(const void *mechanism, const void *frame, int joint, double *vector)
{
    const zd_space_joint *ends = ((const zd_space *)mechanism)->joint + joint;
    const zd_space_pose *pose = ((const zd_space_frame *)frame)->pose;
    const zd_vector3 first = zd_space_point_of(pose + ends->first, ends->point1);
    const zd_vector3 second = zd_space_point_of(pose + ends->second, ends->point2);
    write_vector(zd_minus3(second, first), vector);
}

static const zd_measure_numerics NUMERICS = {3, 3, place, move, zd_space_bias, write_row, unit_wrench, unit_wrenches, reaction_of, apart_of};

static zd_measuring measuring_of(const zd_space *self, const zd_space_frame *frame)
{
    return (zd_measuring){
        .numerics = &NUMERICS, .elements = &self->elements, .readings = zd_space_frame_readings(self, frame), .nv = self->system.nv,
        .joints = self->joints, .is_placed = frame->is_placed, .is_moving = frame->is_moving, .is_least = frame->is_least,
        .least = frame->least, .row = frame->row};
}

static int evaluate(const void *data, const double *inputs, int measure, double t, const double *p, const double *v, const double *vdot,
                    const double *lambda, const zd_measured *out, double *scratch)
{
    const zd_space *self = data;
    zd_space_frame frame = zd_space_frame_of(self, scratch);
    frame.inputs = inputs;
    const zd_measuring measuring = measuring_of(self, &frame);
    return zd_measures_evaluate(&measuring, measure, &(zd_measured_state){t, p, v, vdot, lambda, 0}, out);
}

int zd_space_read(const void *data, int law, double t, const double *p, const double *v, const double *r, int is_same_state, double *u,
                  double *scratch)
{
    const zd_space *self = data;
    const zd_space_frame frame = zd_space_frame_of(self, scratch);
    const zd_measuring measuring = measuring_of(self, &frame);
    return zd_measures_read(&measuring, law, &(zd_measured_state){t, p, v, NULL, NULL, 0}, r, is_same_state, u);
}

static int act_on_body(const zd_space *self, const zd_space_frame *frame, int body, double scale, zd_space_wrench what, double *own)
{
    memset(own, 0, ZD_BODY_VELOCITIES * sizeof *own);
    if (!body) return -1;
    zd_body_act(self->body + body, frame->pose + body, scale, what, own);
    return self->body[body].v;
}

void zd_space_components(const void *mechanism, const double *p, const double *v, int count, const int *which, double *value, int *at,
                         double *row, double *scratch)
{
    const zd_space *self = mechanism;
    const zd_space_frame frame = zd_space_frame_of(self, scratch);
    zd_space_frame_place(self, &frame, p);
    zd_space_frame_move(self, &frame, v);
    for (int i = 0; i < count; i++, row += 2 * ZD_BODY_VELOCITIES, at += 2) {
        const zd_output_spec *measure = self->elements.output + which[2 * i];
        const zd_space_quantity *quantity = self->quantity + measure->index + which[2 * i + 1];
        const zd_space_reading reading = zd_space_quantity_read(quantity, frame.pose);
        const int is_rate = measure->kind == ZD_RATES;
        value[i] = measure->scale * (is_rate ? zd_space_quantity_rate(quantity, frame.pose, frame.twist)
                                             : zd_space_quantity_value(quantity, frame.pose, frame.angle));
        at[0] = act_on_body(self, &frame, quantity->first, measure->scale, reading.first, row);
        at[1] = act_on_body(self, &frame, quantity->second, measure->scale, reading.second, row + ZD_BODY_VELOCITIES);
    }
}

zd_measures zd_space_measures(const zd_space *self, zd_measure *measure)
{
    const int count = self->measures.count;
    zd_output_list(&self->elements, count, NUMERICS.forces, NUMERICS.torques, measure);
    return (zd_measures){count, measure, zd_space_frame_size(self), evaluate};
}
