/* Layout of the scratch memory of a planar mechanism. */
#include "plan.h"
#include "tree.h"

void zd_plane_frame_divide(zd_plane *self)
{
    const size_t bodies = (size_t)self->tree.bodies + 1, longest = self->elements.longest, one = sizeof(double);
    const size_t packed = self->packing ? bodies : 0, composites = bodies - packed;
    const size_t bytes[ZD_PLANE_ARRAYS] = {
        2 * (size_t)self->revolutes * sizeof(zd_vector), 3 * packed * one, self->lines * sizeof(zd_plane_pull),
        self->lines ? 3 * bodies * one : 0, packed * sizeof(zd_vector), bodies * sizeof(zd_plane_pose), bodies * sizeof(zd_plane_twist),
        bodies * sizeof(zd_plane_wrench), composites * sizeof(zd_plane_composite), 3 * bodies * one, one, longest * one, longest * one,
        (longest + 3) * one, one, bodies * sizeof(zd_spin), one, (size_t)self->elements.m * one, (size_t)self->tree.nv * one};
    zd_divide(ZD_PLANE_ARRAYS, ZD_PLANE_OF_MEASURES, bytes, self->frame_at, &self->system, &self->measures);
}

void zd_plane_frame_of(const zd_plane *mechanism, double *scratch, zd_plane_frame *frame)
{
    zd_find_arrays(ZD_PLANE_ARRAYS, mechanism->frame_at, scratch, frame);
    frame->inputs = NULL;
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
