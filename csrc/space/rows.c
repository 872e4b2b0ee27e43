/* A row is a combination of gauges, as in the plane: g(t, x) = 0 of (3), or a_i(t, x) xdot_i + a_0(t, x) = 0 of (5). */
#include "rows.h"

#include "gauge.h"

typedef struct combined {
    double value;           /* g, but for the gauges' own part where the row has no law */
    double explicit_rate;   /* of (5): dg/dt, or a_0 */
    double second;          /* what (6) has besides the gauges' own second derivatives */
    const double *factors;  /* dg/dx_i, or a_i: (terms,) */
} combined;

static const zd_space_gauge *gauge_of(const zd_space *self, const zd_relation *row, int i)
{
    return self->gauge + self->term[row->first + i].gauge;
}

/* Without a law: sum of factors x - constant - slope t; of a nonholonomic one with xdot in place of x. */
static combined combine_linearly(const zd_space *self, const zd_relation *row, double t)
{
    const double target = row->constant + row->slope * t, *factors = self->coefficient + row->first;
    return row->nonholonomic ? (combined){0, -target, -row->slope, factors} : (combined){-target, -row->slope, 0, factors};
}

/* Hands a law the gauges of its row, and takes what it says. */
static int ask_law(const zd_space *self, const zd_frame3 *frame, const zd_relation *row, double t, combined *all)
{
    const int k = row->terms;
    double *out = frame->out;
    for (int i = 0; i < k; i++) {
        frame->x[i] = zd_space_gauge_read(gauge_of(self, row, i), frame->pose).value;
        frame->xdot[i] = zd_space_gauge_rate(gauge_of(self, row, i), frame->pose, frame->twist);
    }
    if (self->law(self->owner, row->law, t, frame->x, frame->xdot, out)) return ZD_CALLBACK;
    *all = (combined){out[0], out[k + 1], out[k + 2], out + 1};
    return ZD_DONE;
}

static int combine(const zd_space *self, const zd_frame3 *frame, const zd_relation *row, double t, combined *all)
{
    if (row->law >= 0) return ask_law(self, frame, row, t, all);
    *all = combine_linearly(self, row, t);
    return ZD_DONE;
}

const double *zd_space_row_factors(const zd_space *self, const zd_frame3 *frame, const zd_relation *row, double t)
{
    combined all;
    return combine(self, frame, row, t, &all) ? NULL : all.factors;
}

static void add_to_row(const zd_space *self, const zd_frame3 *frame, int term, double scale, const zd_reading3 *reading, double *to)
{
    const zd_space_gauge *gauge = self->gauge + self->term[term].gauge;
    const int first = gauge->first, second = gauge->second;
    if (first) zd_body_act(self->body + first, frame->pose + first, scale, reading->first, to + self->near[term]);
    if (second) zd_body_act(self->body + second, frame->pose + second, scale, reading->second, to + self->far[term]);
}

/* Returns the sum of factors x, and adds that of factors times the gauges' rows to `to` unless that is NULL. */
static double add_readings(const zd_space *self, const zd_frame3 *frame, const zd_relation *row, const double *factors, double *to)
{
    double sum = 0;
    for (int i = 0; i < row->terms; i++) {
        const zd_reading3 reading = zd_space_gauge_read(gauge_of(self, row, i), frame->pose);
        sum += factors[i] * reading.value;
        if (to) add_to_row(self, frame, row->first + i, factors[i], &reading, to);
    }
    return sum;
}

static double sum_of_biases(const zd_space *self, const zd_frame3 *frame, const zd_relation *row, const double *factors)
{
    double sum = 0;
    for (int i = 0; i < row->terms; i++) sum += factors[i] * zd_space_gauge_bias(gauge_of(self, row, i), frame->pose, frame->twist);
    return sum;
}

/* The value of a row, less what makes no difference to it. */
static double modulo(double value, double period) { return period > 0 ? remainder(value, period) : value; }

int zd_space_rows_write(const zd_space *self, const zd_frame3 *frame, int want, double t, const zd_terms *out)
{
    for (int i = 0; i < self->m; i++) {
        const zd_relation *row = self->row + i;
        combined all;
        const int status = combine(self, frame, row, t, &all), wants_Phi = (want & ZD_PHI) && i < self->mh;
        if (status) return status;
        if (wants_Phi || want & ZD_C) {
            const double sum = add_readings(self, frame, row, all.factors, want & ZD_C ? out->C + self->at[i] : NULL);      /* (5) */
            if (wants_Phi) out->Phi[i] = modulo(row->law < 0 ? sum + all.value : all.value, self->period[i]);               /* (3) */
        }
        if (want & ZD_PHI_T) out->Phi_t[i] = all.explicit_rate;
        if (want & ZD_XI) out->xi[i] = -all.second - sum_of_biases(self, frame, row, all.factors);                          /* (6) */
    }
    return ZD_DONE;
}
