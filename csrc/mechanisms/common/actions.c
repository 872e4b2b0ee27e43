/* Sums over terms of rows and generalized forces: what plane and space share. Their numerics are functions of the caller. */
#include "actions.h"

#include <limits.h>
#include <math.h>

/* Adds the terms of a row, `scale` times their factors. */
static void add_row(const zd_actions *self, const zd_relation *row, const double *factors, double scale, void *to)
{
    const zd_quantity_term *term = self->elements->term + row->first;
    for (int i = 0; i < row->terms; i++) self->add(self->readings, to, term[i].quantity, scale * factors[i]);
}

/* Adds the effort of index i along a measure. */
static void add_effort(const zd_actions *self, const zd_efforts *efforts, int i)
{
    const int *number = efforts->along + 3 * i;
    const zd_output_spec *along = self->elements->output + number[0];
    self->add(self->readings, self->to, along->index + number[1], along->scale * efforts->effort[i]);
}

int zd_rows_act(const zd_actions *self, const zd_measured_state *at)
{
    const zd_efforts none = {0}, *efforts = at->efforts ? at->efforts : &none;
    for (int i = 0; i < self->elements->m; i++) {
        zd_combined all;
        const int status = zd_combine(self->elements, self->readings, self->elements->row + i, at->t, &all);
        if (status) return status;
        add_row(self, self->elements->row + i, all.factors, -at->lambda[i], self->to);
    }
    for (int i = 0; i < efforts->count; i++) add_effort(self, efforts, i);
    return ZD_DONE;
}

void zd_joint_rows_act(const zd_actions *self, int count, const int *rows, const double *lambda)
{
    for (int k = 0; k < count; k++) {
        const zd_relation *row = self->elements->row + rows[k];
        add_row(self, row, self->elements->coefficient + row->first, -lambda[rows[k]], self->to);
    }
}

static int find_separation(const zd_actions *self, const zd_generalized_force *force, const zd_measured_state *at, double *value)
{
    const int status = zd_drive_force(self->elements, self->readings, force->first, INT_MAX, at->t, at->lambda, value);
    *value = force->stiffness * fabs(*value);
    return status;
}

int zd_drives_act(const zd_actions *self, int joint, const zd_measured_state *at)
{
    const zd_planned_elements *elements = self->elements;
    const zd_efforts none = {0}, *efforts = at->efforts && !at->is_of_constraints ? at->efforts : &none;
    const double t = at->t;
    double value;
    for (int i = 0; i < efforts->count; i++)
        if (efforts->along[3 * i + 2] == joint) add_effort(self, efforts, i);
    for (const zd_generalized_force *force = elements->force; force < elements->force + elements->forces; force++) {
        const int separates = force->kind == ZD_FORCE_SEPARATION;
        if (force->joint != joint || at->is_of_constraints > separates) continue;
        const int status = separates ? find_separation(self, force, at, &value)
                                     : zd_force_evaluate(elements, self->readings, force, t, &value, NULL);
        if (status) return status;
        self->add(self->readings, self->to, force->quantity, value);
    }
    for (int i = 0; i < elements->relations; i++) {
        const zd_relation *row = elements->row + elements->constraint_of_relation[i];
        if (row->joint != joint) continue;
        const int status = zd_drive_force(elements, self->readings, i, 0, t, at->lambda, &value);
        if (status) return status;
        self->add(self->readings, self->to, elements->term[row->first].quantity, value);
    }
    return ZD_DONE;
}

int zd_rows_magnitudes(const zd_actions *self, double t, double *magnitude)
{
    for (int i = 0; i < self->elements->m; i++, magnitude += 2) {
        zd_combined all;
        const int status = zd_combine(self->elements, self->readings, self->elements->row + i, t, &all);
        if (status) return status;
        magnitude[0] = magnitude[1] = 0;
        add_row(self, self->elements->row + i, all.factors, 1, magnitude);
    }
    return ZD_DONE;
}
