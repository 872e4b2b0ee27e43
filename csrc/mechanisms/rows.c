/* A row is a combination of gauges: g(t, x) = 0 of (3), or a_i(t, x) xdot_i + a_0(t, x) = 0 of (5). */
#include "rows.h"

#include "gauge.h"
#include "structure.h"

typedef struct combined {
    double value;           /* g, but for the gauges' own part where the row has no law */
    double explicit_rate;   /* of (5): dg/dt, or a_0 */
    double second;          /* what (6) has besides the gauges' own second derivatives */
    const double *factors;  /* dg/dx_i, or a_i: (terms,) */
} combined;

/* Without a law: sum of factors x - constant - slope t; of a nonholonomic one with xdot in place of x. */
static combined combine_linearly(const zd_mechanism *self, const zd_relation *row, double t)
{
    double target = row->constant + row->slope * t;
    return row->nonholonomic ? (combined){0, -target, -row->slope, self->coefficient + row->first}
                             : (combined){-target, -row->slope, 0, self->coefficient + row->first};
}

/* Hands a law the gauges of its row, and takes what it says. */
static int ask_law(const zd_mechanism *self, const zd_frame *frame, const zd_relation *row, double t, combined *all)
{
    int k = row->terms;
    double *out = frame->out, bias;
    for (int i = 0; i < k; i++) {
        const zd_gauge *gauge = self->gauge + self->term[row->first + i].gauge;
        frame->x[i] = zd_gauge_read(gauge, frame->pose).value;
        frame->xdot[i] = zd_gauge_rate(gauge, frame->pose, frame->twist, &bias);
    }
    if (self->law(self->owner, row->law, t, frame->x, frame->xdot, out)) return ZD_CALLBACK;
    *all = (combined){out[0], out[k + 1], out[k + 2], out + 1};
    return ZD_DONE;
}

static int combine(const zd_mechanism *self, const zd_frame *frame, const zd_relation *row, double t, combined *all)
{
    if (row->law >= 0) return ask_law(self, frame, row, t, all);
    *all = combine_linearly(self, row, t);
    return ZD_DONE;
}

const double *zd_row_factors(const zd_mechanism *self, const zd_frame *frame, const zd_relation *row, double t)
{
    combined all;
    return combine(self, frame, row, t, &all) ? NULL : all.factors;
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

/* Adds what a wrench on a body does to a row, where its entries are stored from `at` on. */
static void add_packed(const zd_mechanism *self, int body, int at, double scale, zd_wrench what, double *to)
{
    if (body) zd_tree_act_on_free(self->tree.link + body, scale, what, to + at);
}

static void add_to_row(const zd_mechanism *self, const zd_frame *frame, int term, double scale, const zd_reading *reading, double *to)
{
    const zd_gauge *gauge = self->gauge + self->term[term].gauge;
    if (self->packing) {
        add_packed(self, gauge->first, self->packing->near[term], scale, reading->first, to);
        add_packed(self, gauge->second, self->packing->far[term], scale, reading->second, to);
    } else {
        zd_tree_inward(&self->tree, frame->pose, gauge->first, scale, reading->first, to);
        zd_tree_inward(&self->tree, frame->pose, gauge->second, scale, reading->second, to);
    }
}

/* Returns the sum of factors x, and adds that of factors times the gauges' rows to `to` unless that is NULL. */
static double add_readings(const zd_mechanism *self, const zd_frame *frame, const zd_relation *row, const double *factors, double *to)
{
    double sum = 0;
    for (int i = 0; i < row->terms; i++) {
        const zd_gauge *gauge = self->gauge + self->term[row->first + i].gauge;
        zd_reading reading = zd_gauge_read(gauge, frame->pose);
        sum += factors[i] * reading.value;
        if (to) add_to_row(self, frame, row->first + i, factors[i], &reading, to);
    }
    return sum;
}

static double sum_of_biases(const zd_mechanism *self, const zd_frame *frame, const zd_relation *row, const double *factors)
{
    double sum = 0, bias;
    for (int i = 0; i < row->terms; i++) {
        zd_gauge_rate(self->gauge + self->term[row->first + i].gauge, frame->pose, frame->twist, &bias);
        sum += factors[i] * bias;
    }
    return sum;
}

int zd_rows_write(const zd_mechanism *self, const zd_frame *frame, int want, double t, const zd_terms *out)
{
    int nv = self->tree.nv;
    for (int i = 0; i < self->m; i++) {
        if (self->packing && self->packing->is_of_pin[i]) continue;
        const zd_relation *row = self->row + i;
        if (self->hinged.is_whole && self->hinged.is_closure[i]) continue;
        combined all;
        int status = combine(self, frame, row, t, &all), wants_Phi = (want & ZD_PHI) && i < self->mh;
        if (status) return status;
        if (wants_Phi || want & ZD_C) {
            int at = self->packing ? self->packing->row[i] : i * nv;
            double sum = add_readings(self, frame, row, all.factors, want & ZD_C ? out->C + at : NULL);         /* (5) */
            if (wants_Phi) out->Phi[i] = row->law < 0 ? sum + all.value : all.value;                            /* (3) */
        }
        if (want & ZD_PHI_T) out->Phi_t[i] = all.explicit_rate;
        if (want & ZD_XI) out->xi[i] = -all.second - sum_of_biases(self, frame, row, all.factors);              /* (6) */
    }
    return ZD_DONE;
}
