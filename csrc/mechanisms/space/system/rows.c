/* A row is a combination of marker quantities, as in the plane: g(t, x) = 0 of (3), or a_i(t, x) xdot_i + a_0(t, x) = 0 of (5). */
#include "rows.h"

#include "../../common/laws.h"
#include "../marker_quantity.h"

static const zd_space_quantity *quantity_of(const zd_space *self, const zd_relation *row, int i)
{
    return self->quantity + self->elements.term[row->first + i].quantity;
}

static void add_to_row(const zd_space *self, const zd_space_frame *frame, int term, double scale, const zd_space_reading *reading, double *to)
{
    const zd_space_quantity *quantity = self->quantity + self->elements.term[term].quantity;
    const int first = quantity->first, second = quantity->second;
    if (self->carrying.act) {
        self->carrying.act(self, frame, quantity, scale, reading, to);
        return;
    }
    if (first) zd_body_act(self->body + first, frame->pose + first, scale, reading->first, to + self->packed.near[term]);
    if (second) zd_body_act(self->body + second, frame->pose + second, scale, reading->second, to + self->packed.far[term]);
}

/* Returns the sum of factors x, and adds that of factors times the marker quantities' rows to `to` unless that is NULL. */
static double add_readings(const zd_space *self, const zd_space_frame *frame, const zd_relation *row, const double *factors, double *to)
{
    double sum = 0;
    for (int i = 0; i < row->terms; i++) {
        const zd_space_reading reading = zd_space_quantity_read(quantity_of(self, row, i), frame->pose);
        sum += factors[i] * zd_space_quantity_counted(quantity_of(self, row, i), reading.value, frame->angle);
        if (to) add_to_row(self, frame, row->first + i, factors[i], &reading, to);
    }
    return sum;
}

static double sum_of_biases(const zd_space *self, const zd_space_frame *frame, const zd_relation *row, const double *factors)
{
    double sum = 0;
    for (int i = 0; i < row->terms; i++)
        sum += factors[i] * zd_space_quantity_bias_with(quantity_of(self, row, i), frame->pose, frame->twist, frame->bias);
    return sum;
}

int zd_space_rows_write(const zd_space *self, const zd_space_frame *frame, int want, double t, const zd_terms *out)
{
    const zd_readings readings = zd_space_frame_readings(self, frame);
    for (int i = 0; i < self->elements.m; i++) {
        if (self->point_joints.has_row[i]) continue;
        const zd_relation *row = self->elements.row + i;
        zd_combined all;
        const int status = zd_combine(&self->elements, &readings, row, t, &all), wants_Phi = (want & ZD_PHI) && i < self->elements.mh;
        if (status) return status;
        if (wants_Phi || want & ZD_C) {
            const int at = self->carrying.act ? i * self->system.nv : self->packed.at[i];
            const double sum = add_readings(self, frame, row, all.factors, want & ZD_C ? out->C + at : NULL);      /* (5) */
            if (wants_Phi) out->Phi[i] = row->law < 0 ? sum + all.value : all.value;               /* (3) */
        }
        if (want & ZD_PHI_T) out->Phi_t[i] = all.explicit_rate;
        if (want & ZD_XI) out->xi[i] = -all.second - sum_of_biases(self, frame, row, all.factors);                          /* (6) */
    }
    return ZD_DONE;
}
