/* A row is a combination of gauges: g(t, x) = 0 of (3), or a_i(t, x) xdot_i + a_0(t, x) = 0 of (5). */
#include "rows.h"

#include "gauge.h"

typedef struct combined {
    double value;           /* g */
    double explicit_rate;   /* of (5): dg/dt, or a_0 */
    double second;          /* what (6) has besides the gauges' own second derivatives */
    const double *factors;  /* dg/dx_i, or a_i: (terms,) */
} combined;

/* Without a law: sum of factors x - constant - slope t; of a nonholonomic one with xdot in place of x. */
static combined combine_linearly(const zd_relation *row, const zd_frame *frame, double t)
{
    double target = row->constant + row->slope * t;
    combined all = {.factors = frame->out};
    if (row->nonholonomic) {
        all.explicit_rate = -target;
        all.second = -row->slope;
    } else {
        all.value = zd_dot(row->terms, frame->out, frame->x) - target;
        all.explicit_rate = -row->slope;
    }
    return all;
}

/* Reads the gauges of a row, with their rates where they are needed, and combines them. */
static int combine(const zd_mechanism *self, const zd_frame *frame, const zd_relation *row, int has_rates, double t, combined *all)
{
    const zd_gauge_term *term = self->term + row->first;
    int k = row->terms, has_law = row->law >= 0;
    for (int i = 0; i < k; i++) {
        const zd_gauge *gauge = self->gauge + term[i].gauge;
        frame->x[i] = zd_gauge_read(gauge, frame->pose).value;
        frame->out[i] = term[i].coefficient;
        if (has_rates || has_law) frame->xdot[i] = zd_gauge_rate(gauge, frame->pose, frame->twist, frame->bias + i);
    }
    if (!has_law) {
        *all = combine_linearly(row, frame, t);
        return ZD_DONE;
    }
    const double *out = frame->out;
    if (self->law(self->owner, row->law, t, frame->x, frame->xdot, frame->out)) return ZD_CALLBACK;
    *all = (combined){out[0], out[k + 1], out[k + 2], out + 1};
    return ZD_DONE;
}

const double *zd_row_factors(const zd_mechanism *self, const zd_frame *frame, const zd_relation *row, double t)
{
    combined all;
    return combine(self, frame, row, 0, t, &all) ? NULL : all.factors;
}

void zd_row_act(const zd_mechanism *self, const zd_frame *frame, const zd_relation *row, const double *factors, double scale)
{
    for (int i = 0; i < row->terms; i++) {
        const zd_gauge *gauge = self->gauge + self->term[row->first + i].gauge;
        zd_reading reading = zd_gauge_read(gauge, frame->pose);
        zd_add_wrench(frame->wrench + gauge->first, scale * factors[i], reading.first);
        zd_add_wrench(frame->wrench + gauge->second, scale * factors[i], reading.second);
    }
}

static void write_jacobian(const zd_mechanism *self, const zd_frame *frame, const zd_relation *row, const double *factors, double *to)
{
    memset(to, 0, (size_t)self->tree.nv * sizeof *to);
    for (int i = 0; i < row->terms; i++) {
        const zd_gauge *gauge = self->gauge + self->term[row->first + i].gauge;
        zd_reading reading = zd_gauge_read(gauge, frame->pose);
        zd_tree_inward(&self->tree, frame->pose, gauge->first, factors[i], reading.first, to);
        zd_tree_inward(&self->tree, frame->pose, gauge->second, factors[i], reading.second, to);
    }
}

int zd_rows_write(const zd_mechanism *self, const zd_frame *frame, int want, double t, const zd_terms *out)
{
    for (int i = 0; i < self->m; i++) {
        const zd_relation *row = self->row + i;
        combined all;
        int status = combine(self, frame, row, want & ZD_XI, t, &all);
        if (status) return status;
        if ((want & ZD_PHI) && i < self->mh) out->Phi[i] = all.value;                                   /* (3) */
        if (want & ZD_C) write_jacobian(self, frame, row, all.factors, out->C + i * self->tree.nv);     /* (5) */
        if (want & ZD_PHI_T) out->Phi_t[i] = all.explicit_rate;
        if (want & ZD_XI) out->xi[i] = -all.second - zd_dot(row->terms, all.factors, frame->bias);      /* (6) */
    }
    return ZD_DONE;
}
