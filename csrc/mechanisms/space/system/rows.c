/* Numerics of rows in space: see ../../common/rows.h. */
#include "system.h"

#include "../../common/rows.h"
#include "../bodies.h"

static double read(const zd_readings *from, int term, double factor, double *to)
{
    const zd_space *self = from->mechanism;
    const zd_space_frame *frame = from->frame;
    const zd_space_quantity *quantity = self->quantity + self->elements.term[term].quantity;
    const zd_space_reading reading = zd_space_quantity_read(quantity, frame->pose);
    const int first = quantity->first, second = quantity->second;
    if (to && self->carrying.act) {
        self->carrying.act(self, frame, quantity, factor, &reading, to);
    } else if (to) {
        if (first) zd_body_act(self->body + first, frame->pose + first, factor, reading.first, to + self->packed.near[term]);
        if (second) zd_body_act(self->body + second, frame->pose + second, factor, reading.second, to + self->packed.far[term]);
    }
    return zd_space_quantity_counted(quantity, reading.value, frame->angle);
}

double zd_space_bias(const void *mechanism, const void *frame, int quantity)
{
    const zd_space *self = mechanism;
    const zd_space_frame *at = frame;
    return zd_space_quantity_bias(self->quantity + quantity, at->pose, at->twist, at->bias);
}

int zd_space_rows_write(const zd_space *self, const zd_space_frame *frame, int want, double t, const zd_terms *out)
{
    const zd_readings readings = zd_space_frame_readings(self, frame);
    const zd_constraint_numerics numerics = {
        .elements = &self->elements, .nv = self->system.nv,
        .at = self->carrying.act ? NULL : self->packed.at, .is_elsewhere = self->point_joints.has_row, .read = read, .bias = zd_space_bias,
    };
    return zd_rows_write(&numerics, &readings, want, t, out);
}
