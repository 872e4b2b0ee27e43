/* Measures of several bodies together: sums over marker quantities, such as the momentum, and moments of momentum about the origin. */
#include "output_spec.h"

#include <math.h>

#include "../../linalg/small.h"

static double acceleration_of(const zd_measuring *self, int quantity, const double *vdot)
{
    const zd_readings *of = self->readings;
    self->numerics->write_row(of->mechanism, of->frame, quantity, 1, self->row, NULL);
    return self->numerics->bias(of->mechanism, of->frame, quantity) + zd_dot(self->nv, self->row, vdot);
}

/* Component of a sum: `terms` from `term` on */
static void add_up(const zd_measuring *self, int kind, const zd_quantity_term *term, int terms, const zd_measured_state *at, double sum[3],
                   double *jacobian)
{
    const zd_readings *of = self->readings;
    sum[0] = sum[1] = sum[2] = 0;
    for (const zd_quantity_term *end = term + terms; term < end; term++) {
        const int quantity = term->quantity;
        const double factor = term->coefficient;
        if (quantity < 0) {
            sum[0] += factor;
            continue;
        }
        if (kind == ZD_SUM_OF_ACCELERATIONS) {
            sum[0] += factor * acceleration_of(self, quantity, at->vdot);
            continue;
        }
        const double rate = zd_rate_of(of, quantity);
        sum[0] += factor * (kind == ZD_SUM ? zd_value_of(of, quantity) : rate);
        sum[1] += factor * rate;
        sum[2] += factor * self->numerics->bias(of->mechanism, of->frame, quantity);
        if (!jacobian) continue;
        self->numerics->write_row(of->mechanism, of->frame, quantity, factor, self->row, NULL);
        for (int k = 0; k < self->nv; k++) jacobian[k] += self->row[k];
    }
}

void zd_sum_measure(const zd_measuring *self, const zd_output_spec *measure, const zd_measured_state *at, const zd_measured *out)
{
    const zd_quantity_term *term = self->elements->term + measure->term;
    const int has_rows = measure->kind != ZD_SUM_OF_ACCELERATIONS;
    for (int i = 0; i < measure->size / measure->index; i++, term += measure->index) {
        double sum[3], *jacobian = has_rows && out->jacobian ? out->jacobian + i * self->nv : NULL;
        if (jacobian) zd_clear(self->nv, jacobian);
        add_up(self, measure->kind, term, measure->index, at, sum, jacobian);
        if (out->value) out->value[i] = sum[0];
        if (has_rows && out->rate) out->rate[i] = sum[1];
        if (has_rows && out->bias) out->bias[i] = sum[2];
    }
}

/* to (3,) += factor a x b */
static void add_cross(double factor, const double *a, const double *b, double *to)
{
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        to[i] += factor * (a[j] * b[k] - a[k] * b[j]);
    }
}

/* Moment of momentum of a body about its mass centre, h = sum J_i w_i e_i of its principal axes, or dh/dt = sum J_i dw_i/dt e_i + w x h */
static void add_spins(const zd_measuring *self, const zd_quantity_term *term, int spins, const double *vdot, double *to)
{
    const zd_readings *of = self->readings;
    double spin[3] = {0}, own[3] = {0};
    for (int i = 0; i < spins; i++) {
        double wrench[ZD_WRENCH_SIZE] = {0}, *e = wrench + ZD_WRENCH_FORCE;
        if (term[i].coefficient == 0) continue;
        self->numerics->unit_wrench(of->mechanism, of->frame, term[i].quantity, wrench);
        if (spins == 1) e[2] = e[0], e[0] = 0;
        const double w = zd_rate_of(of, term[i].quantity), change = vdot ? acceleration_of(self, term[i].quantity, vdot) : w;
        for (int k = 0; k < 3; k++) {
            spin[k] += w * e[k];
            own[k] += term[i].coefficient * w * e[k];
            to[k] += term[i].coefficient * change * e[k];
        }
    }
    if (vdot) add_cross(1, spin, own, to);
}

void zd_momentum_measure(const zd_measuring *self, const zd_output_spec *measure, const zd_measured_state *at, double *value)
{
    const zd_readings *of = self->readings;
    const zd_quantity_term *term = self->elements->term + measure->term, *end = term + measure->size;
    const int n = self->numerics->forces, spins = self->numerics->torques, is_rate = measure->kind == ZD_INERTIA_TORQUE;
    double sum[3] = {0}, gravity[3] = {0};
    if (is_rate) end -= n;
    for (int i = 0; i < n && is_rate; i++) gravity[i] = end[i].coefficient;
    for (; term < end; term += measure->index) {
        double r[3] = {0}, rate[3] = {0};
        for (int i = 0; i < n; i++) {
            r[i] = zd_value_of(of, term[i].quantity);
            rate[i] = is_rate ? acceleration_of(self, term[i].quantity, at->vdot) - gravity[i] : zd_rate_of(of, term[i].quantity);
        }
        add_cross(term->coefficient, r, rate, sum);
        add_spins(self, term + n, spins, is_rate ? at->vdot : NULL, sum);
    }
    for (int k = 0; k < spins; k++) value[k] = measure->scale * sum[n == 2 ? 2 : k];
}
