#include "problem.h"

#include <string.h>

#include "../../../linalg/small.h"

/* ---- few bodies ---- */

/* self->value and self->jacobian <- measure of a target */
static void read_target(zd_assembly *self, const zd_target *target, const double *p)
{
    const zd_measured out = {.value = self->value, .jacobian = self->jacobian};
    const zd_measures *all = self->system->measures;
    const int status = all->evaluate(self->system->data, self->given->inputs, target->measure, self->given->t, p, self->at_rest, NULL,
                                     NULL, &out, self->measures);
    if (status && !self->status) self->status = status < 0 ? status : ZD_CALLBACK;
}

/* Residuals and rows of the chosen targets */
static void add_dense_targets(zd_assembly *self, int roles, int is_rate, const double *p)
{
    int last = -1;
    for (int i = 0; i < self->given->targets; i++) {
        const zd_target *target = self->given->target + i;
        if (!(roles & 1 << target->role) || target->is_rate != is_rate) continue;
        if (target->measure != last) read_target(self, target, p);
        last = target->measure;
        self->r[self->rows] = self->value[target->component] - self->target[i];
        double *to = zd_assembly_begin_row(self, self->m + i, self->entries + self->rows * self->n, self->n, NULL);
        zd_copy_all(self->n, self->jacobian + target->component * self->n, to);
    }
}

/* ---- many bodies ---- */

/* Components of the chosen targets, all at once; returns their number. */
static int read_components(zd_assembly *self, int roles, int is_rate, const double *p)
{
    const zd_many_bodies *many = self->given->many;
    int count = 0;
    for (int i = 0; i < self->given->targets; i++) {
        const zd_target *target = self->given->target + i;
        if (!(roles & 1 << target->role) || target->is_rate != is_rate) continue;
        self->which[2 * count] = target->measure;
        self->which[2 * count++ + 1] = target->component;
    }
    zd_clear(2 * many->width * count, self->jacobian);
    if (count) many->components(many->mechanism, p, self->at_rest, count, self->which, self->value, self->at, self->jacobian, self->measures);
    return count;
}

/* Entries of one body, in front of those that there are or added to these; returns the number of entries. */
static int add_body(const zd_assembly *self, int at, const double *row, int count, double *x, int *column)
{
    if (at < 0) return count;
    const int b = self->layout->block_of[at], size = self->layout->velocity_at[b + 1] - at;
    if (count && column[0] == at) {
        zd_add_scaled(size, x, 1, row);
        return count;
    }
    memmove(x + size, x, count * sizeof *x);
    memmove(column + size, column, count * sizeof *column);
    for (int j = 0; j < size; j++) x[j] = row[j], column[j] = at + j;
    return count + size;
}

static void add_sparse_targets(zd_assembly *self, int roles, int is_rate, const double *p)
{
    const int width = self->given->many->width;
    int k = 0;
    if (!read_components(self, roles, is_rate, p)) return;
    for (int i = 0; i < self->given->targets; i++) {
        const zd_target *target = self->given->target + i;
        if (!(roles & 1 << target->role) || target->is_rate != is_rate) continue;
        const int *at = self->at + 2 * k, last = at[1] > at[0];     /* the later body first, as columns increase */
        const double *row = self->jacobian + 2 * width * k;
        double *x = self->entries + self->size_of_C + 2 * width * i;
        int *column = self->column + 2 * width * i, count = add_body(self, at[last], row + last * width, 0, x, column);
        count = add_body(self, at[!last], row + !last * width, count, x, column);
        self->r[self->rows] = self->value[k++] - self->target[i];
        zd_assembly_begin_row(self, self->m + i, x, count, column);
    }
}

void zd_assembly_add_targets(zd_assembly *self, int roles, int is_rate, const double *p)
{
    if (self->layout) add_sparse_targets(self, roles, is_rate, p);
    else add_dense_targets(self, roles, is_rate, p);
}

void zd_assembly_save(zd_assembly *self, const double *p)
{
    const int roles = 1 << ZD_TARGET_STAYS, is_dense = !self->layout;
    int k = 0;
    if (!is_dense) read_components(self, roles, 0, p);
    for (int i = 0; i < self->given->targets; i++) {
        const zd_target *target = self->given->target + i;
        if (target->role != ZD_TARGET_STAYS || target->is_rate) continue;
        if (is_dense) read_target(self, target, p);
        self->target[i] = self->value[is_dense ? target->component : k++];
    }
}
