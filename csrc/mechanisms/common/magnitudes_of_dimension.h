/* Magnitudes of the gradients of constraints and of generalized forces before cancellation, one text for the plane and for space: compiled
 * once by a source of each, which defines MECHANISM, its type; OF(name), a name of its dimension; BODIES(mechanism), MASS(mechanism, body);
 * norm() of a vector, VECTOR_OF(components); is_angular() of a kind of marker quantity; TORQUE(wrench), where moments add up, and its size.
 *
 * In joint coordinates a constraint that the tree already satisfies, as a brace between bodies that are welded together, has a gradient that
 * is the difference of equal terms: rounding. Its size is therefore not taken from C but from the terms: a unit vector for a velocity of a
 * mass centre; for an angular velocity a unit vector times a lever arm, at most the mechanism's length and the distances of both points from
 * the origin. A force on a body has a moment with the mechanism's length and the distance of the body from the origin as lever arm.
 */

static double distance_of(const OF(pose) *pose, const double *point) { return norm(pose->at) + norm(VECTOR_OF(point)); }

static void add(const zd_readings *at, void *to, int quantity, double factor)
{
    const MECHANISM *self = at->mechanism;
    const OF(pose) *pose = ((const OF(frame) *)at->frame)->pose;
    const OF(quantity) *of = self->quantity + quantity;
    double *magnitude = to;
    const double size = fabs(factor);
    if (is_angular(of->kind)) {
        magnitude[1] += size;
        return;
    }
    const double lever = distance_of(pose + of->first, of->point1) + distance_of(pose + of->second, of->point2);
    magnitude[0] += size;
    magnitude[1] += size * (self->system.length + lever);
}

int OF(row_sizes)(const MECHANISM *self, const OF(frame) *frame, double t, double *magnitude)
{
    const zd_readings readings = OF(frame_readings)(self, frame);
    const zd_actions actions = {&self->elements, &readings, add, NULL};
    return zd_rows_magnitudes(&actions, t, magnitude);
}

static void add_size(const MECHANISM *self, const OF(frame) *frame, int body, double size, OF(wrench) unit)
{
    const double force = size * norm(unit.force), lever = self->system.length + norm(frame->pose[body].at);
    frame->wrench[body].force.x += force;
    TORQUE(frame->wrench[body]) += size * size_of_torque(unit) + lever * force;
}

static void add_force(const zd_readings *at, void *unused, int index, double value)
{
    (void)unused;
    const MECHANISM *self = at->mechanism;
    const OF(frame) *frame = at->frame;
    const OF(quantity) *quantity = self->quantity + index;
    const OF(reading) reading = OF(quantity_read)(quantity, frame->pose);
    add_size(self, frame, quantity->first, fabs(value), reading.first);
    add_size(self, frame, quantity->second, fabs(value), reading.second);
}

int OF(force_sizes)(const MECHANISM *self, const OF(frame) *frame, double t)
{
    const zd_readings readings = OF(frame_readings)(self, frame);
    const zd_actions actions = {&self->elements, &readings, add_force, NULL};
    memset(frame->wrench, 0, (BODIES(self) + 1) * sizeof *frame->wrench);
    for (int i = 1; i <= BODIES(self); i++) add_size(self, frame, i, MASS(self, i), (OF(wrench)){.force = self->gravity});
    return zd_forces_act(&actions, t);
}
