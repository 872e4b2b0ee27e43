/* Numerics of rows in the plane: see ../../common/rows.h. */
#include "system.h"

#include "../../common/rows.h"
#include "../structure/packing.h"
#include "../tree.h"

/* Adds what a wrench on a body does to a row, where its entries are stored from `at` on. */
static void add_packed(const zd_plane *self, int body, int at, double scale, zd_plane_wrench what, double *to)
{
    if (body) zd_plane_tree_act_on_free(self->tree.link + body, scale, what, to + at);
}

static double read(const zd_readings *from, int term, double factor, double *to)
{
    const zd_plane *self = from->mechanism;
    const zd_plane_frame *frame = from->frame;
    const zd_plane_quantity *quantity = self->quantity + self->elements.term[term].quantity;
    const zd_plane_reading reading = zd_plane_quantity_read(quantity, frame->pose);
    if (to && self->packing) {
        add_packed(self, quantity->first, self->packing->packed.near[term], factor, reading.first, to);
        add_packed(self, quantity->second, self->packing->packed.far[term], factor, reading.second, to);
    } else if (to) {
        zd_plane_tree_inward(&self->tree, frame->pose, quantity->first, factor, reading.first, to);
        zd_plane_tree_inward(&self->tree, frame->pose, quantity->second, factor, reading.second, to);
    }
    return reading.value;
}

double zd_plane_bias(const void *mechanism, const void *frame, int quantity)
{
    const zd_plane *self = mechanism;
    const zd_plane_frame *at = frame;
    double bias;
    zd_plane_quantity_rate(self->quantity + quantity, at->pose, at->twist, &bias);
    return bias;
}

int zd_plane_rows_write(const zd_plane *self, const zd_plane_frame *frame, int want, double t, const zd_terms *out)
{
    const zd_packing *packing = self->packing;
    const zd_readings readings = zd_plane_frame_readings(self, frame);
    const zd_constraint_numerics numerics = {
        .elements = &self->elements, .nv = self->tree.nv,
        .at = packing ? packing->packed.at : NULL,
        .is_elsewhere = packing ? packing->is_known : self->hinged.is_complete ? self->hinged.is_closure : NULL,
        .read = read, .bias = zd_plane_bias,
    };
    return zd_rows_write(&numerics, &readings, want, t, out);
}
