/* How the scratch of a mechanism is divided. */
#include "gauge.h"
#include "plan.h"

/* The next `count` structures of `size` doubles each. */
static double *next(double *scratch, int *used, int count, size_t bytes)
{
    double *here = scratch ? scratch + *used : NULL;
    *used += count * (int)(bytes / sizeof(double));
    return here;
}

static int divide(const zd_mechanism *self, double *scratch, zd_frame *to)
{
    int used = 0, bodies = self->tree.bodies + 1, longest = self->uses.longest;
    to->arm = (zd_vector *)next(scratch, &used, 2 * self->pins, sizeof(zd_vector));     /* these two are first: see products.c */
    to->spread = next(scratch, &used, self->packing ? 3 * bodies : 0, sizeof(double));
    to->pull = (zd_pull *)next(scratch, &used, self->lines, sizeof(zd_pull));
    to->place = next(scratch, &used, self->lines ? 3 * bodies : 0, sizeof(double));
    to->axis = (zd_vector *)next(scratch, &used, self->packing ? bodies : 0, sizeof(zd_vector));
    to->pose = (zd_pose *)next(scratch, &used, bodies, sizeof(zd_pose));
    to->twist = (zd_twist *)next(scratch, &used, bodies, sizeof(zd_twist));
    to->wrench = (zd_wrench *)next(scratch, &used, bodies, sizeof(zd_wrench));
    to->composite = (zd_composite *)next(scratch, &used, bodies, sizeof(zd_composite));
    to->spin = (zd_spin *)next(scratch, &used, bodies, sizeof(zd_spin));
    to->sines = next(scratch, &used, 3 * bodies, sizeof(double));
    to->is_placed = next(scratch, &used, 1, sizeof(double));
    to->is_moving = next(scratch, &used, 1, sizeof(double));
    to->row = next(scratch, &used, self->tree.nv, sizeof(double));
    to->x = next(scratch, &used, longest, sizeof(double));
    to->xdot = next(scratch, &used, longest, sizeof(double));
    to->out = next(scratch, &used, longest + 3, sizeof(double));
    return used;
}

zd_frame zd_frame_of(const zd_mechanism *mechanism, double *scratch)
{
    zd_frame frame;
    divide(mechanism, scratch, &frame);
    return frame;
}

int zd_frame_size(const zd_mechanism *mechanism)
{
    zd_frame frame;
    return divide(mechanism, NULL, &frame);
}

static double value_of(const void *mechanism, const void *frame, int gauge)
{
    const zd_mechanism *self = mechanism;
    const zd_frame *at = frame;
    return zd_gauge_read(self->gauge + gauge, at->pose).value;
}

static double rate_of(const void *mechanism, const void *frame, int gauge)
{
    const zd_mechanism *self = mechanism;
    const zd_frame *at = frame;
    double bias;
    return zd_gauge_rate(self->gauge + gauge, at->pose, at->twist, &bias);
}

zd_readings zd_frame_readings(const zd_mechanism *mechanism, const zd_frame *frame)
{
    return (zd_readings){value_of, rate_of, mechanism, frame, frame->x, frame->xdot, frame->out};
}
