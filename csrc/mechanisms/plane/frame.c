/* Layout of the scratch memory of a planar mechanism. */
#include "plan.h"
#include "tree.h"

/* Offset of the next `count` structures of `bytes` each. */
static size_t next(size_t *used, int count, size_t bytes)
{
    const size_t here = *used;
    *used += (size_t)count * bytes;
    return here;
}

int zd_plane_frame_divide(const zd_plane *self, zd_plane_frame_at *to)
{
    size_t used = 0;
    const int bodies = self->tree.bodies + 1, longest = self->elements.longest;
    to->arm = next(&used, 2 * self->revolutes, sizeof(zd_vector));     /* these two are first: see products.c */
    to->spread = next(&used, self->packing ? 3 * bodies : 0, sizeof(double));
    to->pull = next(&used, self->lines, sizeof(zd_plane_pull));
    to->place = next(&used, self->lines ? 3 * bodies : 0, sizeof(double));
    to->axis = next(&used, self->packing ? bodies : 0, sizeof(zd_vector));
    to->pose = next(&used, bodies, sizeof(zd_plane_pose));
    to->twist = next(&used, bodies, sizeof(zd_plane_twist));
    to->wrench = next(&used, bodies, sizeof(zd_plane_wrench));
    to->composite = next(&used, bodies, sizeof(zd_plane_composite));
    to->spin = next(&used, bodies, sizeof(zd_spin));
    to->sines = next(&used, 3 * bodies, sizeof(double));
    to->is_placed = next(&used, 1, sizeof(double));
    to->is_moving = next(&used, 1, sizeof(double));
    to->is_least = next(&used, 1, sizeof(double));
    to->least = next(&used, self->elements.m, sizeof(double));
    to->row = next(&used, self->tree.nv, sizeof(double));
    to->x = next(&used, longest, sizeof(double));
    to->xdot = next(&used, longest, sizeof(double));
    to->out = next(&used, longest + 3, sizeof(double));
    return (int)(used / sizeof(double));
}

zd_plane_frame zd_plane_frame_of(const zd_plane *mechanism, double *scratch)
{
    const zd_plane_frame_at *at = &mechanism->frame_at;
    char *begin = (char *)scratch;
    return (zd_plane_frame){
        .pose = (void *)(begin + at->pose),
        .twist = (void *)(begin + at->twist),
        .wrench = (void *)(begin + at->wrench),
        .composite = (void *)(begin + at->composite),
        .spin = (void *)(begin + at->spin),
        .axis = (void *)(begin + at->axis),
        .arm = (void *)(begin + at->arm),
        .spread = (void *)(begin + at->spread),
        .pull = (void *)(begin + at->pull),
        .place = (void *)(begin + at->place),
        .sines = (void *)(begin + at->sines),
        .is_placed = (void *)(begin + at->is_placed),
        .is_moving = (void *)(begin + at->is_moving),
        .is_least = (void *)(begin + at->is_least),
        .least = (void *)(begin + at->least),
        .row = (void *)(begin + at->row),
        .x = (void *)(begin + at->x),
        .xdot = (void *)(begin + at->xdot),
        .out = (void *)(begin + at->out),
    };
}

static double value_of(const void *mechanism, const void *frame, int quantity)
{
    const zd_plane *self = mechanism;
    const zd_plane_frame *at = frame;
    return zd_plane_quantity_read(self->quantity + quantity, at->pose).value;
}

static double rate_of(const void *mechanism, const void *frame, int quantity)
{
    const zd_plane *self = mechanism;
    const zd_plane_frame *at = frame;
    double bias;
    return zd_plane_quantity_rate(self->quantity + quantity, at->pose, at->twist, &bias);
}

zd_readings zd_plane_frame_readings(const zd_plane *mechanism, const zd_plane_frame *frame)
{
    return (zd_readings){value_of, rate_of, mechanism, frame, frame->inputs, frame->x, frame->xdot, frame->out};
}
