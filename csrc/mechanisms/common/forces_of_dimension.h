/* Applied forces of a mechanism, one text for the plane and for space: compiled once by a source of each, which defines MECHANISM, its type;
 * OF(name), a name of its dimension; BODIES(mechanism); and weight(), weight_potential() of a body.
 *
 * A generalized force along a marker quantity acts on each body with its value times the unit wrench of that quantity. */

ZD_INLINE void add(const zd_readings *at, void *unused, int index, double force)
{
    (void)unused;
    const OF(frame) *frame = at->frame;
    const OF(quantity) *quantity = ((const MECHANISM *)at->mechanism)->quantity + index;
    const OF(reading) reading = OF(quantity_read)(quantity, frame->pose);
    OF(add_wrench)(frame->wrench + quantity->first, force, reading.first);
    OF(add_wrench)(frame->wrench + quantity->second, force, reading.second);
}

void OF(add_force)(const zd_readings *at, void *unused, int index, double force) { add(at, unused, index, force); }

int OF(forces_apply)(const MECHANISM *self, const OF(frame) *frame, double t)
{
    const zd_readings readings = OF(frame_readings)(self, frame);
    const zd_actions actions = {&self->elements, &readings, add, NULL};
    for (int i = 0; i <= BODIES(self); i++) frame->wrench[i] = weight(self, i);
    return zd_forces_act(&actions, t);
}

int OF(power)(const MECHANISM *self, const OF(frame) *frame, double t, double *power)
{
    const zd_readings at = OF(frame_readings)(self, frame);
    return zd_forces_power(&self->elements, &at, t, power);
}

double OF(potential)(const MECHANISM *self, const OF(frame) *frame)
{
    const zd_readings at = OF(frame_readings)(self, frame);
    double V = 0;
    for (int i = 1; i <= BODIES(self); i++) V -= weight_potential(self, frame, i);
    return zd_springs_potential(&self->elements, &at, V);
}
