/* A row is a combination of marker quantities: g(t, x) = 0 of (3), or a_i(t, x) xdot_i + a_0(t, x) = 0 of (5). */
#include "rows.h"

#include "../../common/laws.h"
#include "../marker_quantity.h"
#include "../structure/structure.h"

void zd_plane_row_act(const zd_plane *self, const zd_plane_frame *frame, const zd_relation *row, const double *factors, double scale)
{
    for (int i = 0; i < row->terms; i++) {
        const zd_plane_quantity *quantity = self->quantity + self->elements.term[row->first + i].quantity;
        zd_plane_reading reading = zd_plane_quantity_read(quantity, frame->pose);
        zd_plane_add_wrench(frame->wrench + quantity->first, scale * factors[i], reading.first);
        zd_plane_add_wrench(frame->wrench + quantity->second, scale * factors[i], reading.second);
    }
}

/* Adds what a wrench on a body does to a row, where its entries are stored from `at` on. */
static void add_packed(const zd_plane *self, int body, int at, double scale, zd_plane_wrench what, double *to)
{
    if (body) zd_plane_tree_act_on_free(self->tree.link + body, scale, what, to + at);
}

static void add_to_row(const zd_plane *self, const zd_plane_frame *frame, int term, double scale, const zd_plane_reading *reading, double *to)
{
    const zd_plane_quantity *quantity = self->quantity + self->elements.term[term].quantity;
    if (self->packing) {
        add_packed(self, quantity->first, self->packing->packed.near[term], scale, reading->first, to);
        add_packed(self, quantity->second, self->packing->packed.far[term], scale, reading->second, to);
    } else {
        zd_plane_tree_inward(&self->tree, frame->pose, quantity->first, scale, reading->first, to);
        zd_plane_tree_inward(&self->tree, frame->pose, quantity->second, scale, reading->second, to);
    }
}

/* Returns the sum of factors x, and adds that of factors times the marker quantities' rows to `to` unless that is NULL. */
static double add_readings(const zd_plane *self, const zd_plane_frame *frame, const zd_relation *row, const double *factors, double *to)
{
    double sum = 0;
    for (int i = 0; i < row->terms; i++) {
        const zd_plane_quantity *quantity = self->quantity + self->elements.term[row->first + i].quantity;
        zd_plane_reading reading = zd_plane_quantity_read(quantity, frame->pose);
        sum += factors[i] * reading.value;
        if (to) add_to_row(self, frame, row->first + i, factors[i], &reading, to);
    }
    return sum;
}

static double sum_of_biases(const zd_plane *self, const zd_plane_frame *frame, const zd_relation *row, const double *factors)
{
    double sum = 0, bias;
    for (int i = 0; i < row->terms; i++) {
        zd_plane_quantity_rate(self->quantity + self->elements.term[row->first + i].quantity, frame->pose, frame->twist, &bias);
        sum += factors[i] * bias;
    }
    return sum;
}

int zd_plane_rows_write(const zd_plane *self, const zd_plane_frame *frame, int want, double t, const zd_terms *out)
{
    const zd_readings readings = zd_plane_frame_readings(self, frame);
    int nv = self->tree.nv;
    for (int i = 0; i < self->elements.m; i++) {
        if (self->packing && self->packing->is_known[i]) continue;
        const zd_relation *row = self->elements.row + i;
        if (self->hinged.is_whole && self->hinged.is_closure[i]) continue;
        zd_combined all;
        int status = zd_combine(&self->elements, &readings, row, t, &all), wants_Phi = (want & ZD_PHI) && i < self->elements.mh;
        if (status) return status;
        if (wants_Phi || want & ZD_C) {
            int at = self->packing ? self->packing->packed.at[i] : i * nv;
            double sum = add_readings(self, frame, row, all.factors, want & ZD_C ? out->C + at : NULL);         /* (5) */
            if (wants_Phi) out->Phi[i] = row->law < 0 ? sum + all.value : all.value;                            /* (3) */
        }
        if (want & ZD_PHI_T) out->Phi_t[i] = all.explicit_rate;
        if (want & ZD_XI) out->xi[i] = -all.second - sum_of_biases(self, frame, row, all.factors);              /* (6) */
    }
    return ZD_DONE;
}
