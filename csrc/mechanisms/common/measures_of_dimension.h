/* Measures of a mechanism, one text for the plane and for space: compiled once by a source of each, which defines MECHANISM, its type;
 * OF(name), a name of its dimension; FORCES and TORQUES, numbers of components; MINUS and POINT_OF; place(), move(), write_row(),
 * write_vector(), write_wrench() and act_on_body(), which writes VELOCITIES entries. */

static void unit_wrench(const void *mechanism, const void *frame, int quantity, double *wrench)
{
    const MECHANISM *self = mechanism;
    const OF(frame) *at = frame;
    write_wrench(OF(quantity_read)(self->quantity + quantity, at->pose).second, wrench);
}

static void unit_wrenches(const void *mechanism, const void *frame, int index, int *body, double *wrench)
{
    const OF(quantity) *quantity = ((const MECHANISM *)mechanism)->quantity + index;
    const OF(reading) reading = OF(quantity_read)(quantity, ((const OF(frame) *)frame)->pose);
    body[0] = quantity->first, body[1] = quantity->second;
    memset(wrench, 0, 2 * ZD_WRENCH_SIZE * sizeof *wrench);
    write_wrench(reading.first, wrench);
    write_wrench(reading.second, wrench + ZD_WRENCH_SIZE);
}

static int reaction_of(const void *mechanism, const void *frame, int joint, const zd_measured_state *at, double *wrench)
{
    OF(wrench) reaction;
    const int status = OF(joint_reaction)(mechanism, frame, joint, at, &reaction);
    write_wrench(reaction, wrench);
    return status;
}

static void apart_of(const void *mechanism, const void *frame, int joint, double *vector)
{
    const OF(joint) *ends = ((const MECHANISM *)mechanism)->joint + joint;
    const OF(pose) *pose = ((const OF(frame) *)frame)->pose;
    write_vector(MINUS(POINT_OF(pose + ends->second, ends->point2), POINT_OF(pose + ends->first, ends->point1)), vector);
}

static const zd_measure_numerics NUMERICS = {
    FORCES, TORQUES, place, move, OF(bias), write_row, unit_wrench, unit_wrenches, reaction_of, apart_of};

static zd_measuring measuring_of(const MECHANISM *self, const OF(frame) *frame, const zd_readings *readings)
{
    return (zd_measuring){
        .numerics = &NUMERICS, .elements = &self->elements, .readings = readings, .nv = self->system.nv,
        .joints = self->joints, .is_placed = frame->is_placed, .is_moving = frame->is_moving, .is_least = frame->is_least,
        .least = frame->least, .row = frame->row};
}

static int evaluate(const void *data, const double *inputs, int measure, double t, const double *p, const double *v, const double *vdot,
                    const double *lambda, const zd_measured *out, double *scratch)
{
    const MECHANISM *self = data;
    OF(frame) frame;
    OF(frame_of)(self, scratch, &frame);
    frame.inputs = inputs;
    const zd_readings readings = OF(frame_readings)(self, &frame);
    const zd_measuring measuring = measuring_of(self, &frame, &readings);
    return zd_measures_evaluate(&measuring, measure, &(zd_measured_state){t, p, v, vdot, lambda, 0, out->efforts}, out);
}

int OF(read)(const void *data, int law, double t, const double *p, const double *v, const double *r, int is_same_state, double *u,
             double *scratch)
{
    const MECHANISM *self = data;
    OF(frame) frame;
    OF(frame_of)(self, scratch, &frame);
    const zd_readings readings = OF(frame_readings)(self, &frame);
    const zd_measuring measuring = measuring_of(self, &frame, &readings);
    return zd_measures_read(&measuring, law, &(zd_measured_state){t, p, v, NULL, NULL, 0, NULL}, r, is_same_state, u);
}

static zd_readings readings_at(const MECHANISM *self, const double *p, const double *v, double *scratch, OF(frame) *frame)
{
    OF(frame_of)(self, scratch, frame);
    const zd_readings readings = OF(frame_readings)(self, frame);
    place(self, frame, p);
    move(self, frame, v);
    return readings;
}

int OF(check_domain)(const void *data, double rtol, double atol, double t, const double *p, const double *v, double *scratch)
{
    const MECHANISM *self = data;
    if (!zd_laws_check(&self->elements, NULL, rtol, atol, t)) return ZD_DONE;
    OF(frame) frame;
    const zd_readings readings = readings_at(self, p, v, scratch, &frame);
    return zd_laws_check(&self->elements, &readings, rtol, atol, t);
}

void OF(compare)(const void *data, double t, const double *p, const double *v, double *value, double *scratch)
{
    const MECHANISM *self = data;
    OF(frame) frame;
    const zd_readings readings = readings_at(self, p, v, scratch, &frame);
    zd_laws_compare(&self->elements, &readings, t, value);
}

zd_measures OF(measures)(const MECHANISM *self, zd_measure *measure)
{
    const int count = self->measures.count;
    zd_output_list(&self->elements, count, NUMERICS.forces, NUMERICS.torques, measure);
    return (zd_measures){count, measure, 0, evaluate};
}

void OF(components)(const void *mechanism, const double *p, const double *v, int count, const int *which, double *value, int *at, double *row,
                    double *scratch)
{
    const MECHANISM *self = mechanism;
    OF(frame) frame;
    const zd_readings readings = readings_at(self, p, v, scratch, &frame);
    for (int i = 0; i < count; i++, row += 2 * VELOCITIES, at += 2) {
        const zd_output_spec *measure = self->elements.output + which[2 * i];
        const int index = measure->index + which[2 * i + 1];
        const OF(quantity) *quantity = self->quantity + index;
        const OF(reading) reading = OF(quantity_read)(quantity, frame.pose);
        value[i] = measure->scale * (measure->kind == ZD_RATES ? zd_rate_of : zd_value_of)(&readings, index);
        at[0] = act_on_body(self, &frame, quantity->first, measure->scale, reading.first, row);
        at[1] = act_on_body(self, &frame, quantity->second, measure->scale, reading.second, row + VELOCITIES);
    }
}
