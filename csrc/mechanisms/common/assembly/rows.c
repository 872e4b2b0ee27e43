#include "problem.h"

#include <math.h>

#include "../../../linalg/small.h"

int zd_assembly_has(const zd_assembly *self, enum zd_target_role role, int is_rate)
{
    int any = 0;
    for (int i = 0; i < self->given->targets; i++) {
        const zd_target *target = self->given->target + i;
        any |= target->role == (int)role && target->is_rate == is_rate;
    }
    return any;
}

double zd_assembly_row_times(const zd_assembly *self, int row, const double *x)
{
    const zd_sparse_row *J = self->J + row;
    return zd_row_times(&(zd_row_of_C){J->x, J->count, J->column}, x);
}

double zd_assembly_length_of(const zd_assembly *self, int row)
{
    return sqrt(zd_dot(self->J[row].count, self->J[row].x, self->J[row].x));
}

void zd_assembly_divide_row(zd_assembly *self, int row, double by)
{
    self->r[row] /= by;
    for (int j = 0; j < self->J[row].count; j++) self->J[row].x[j] /= by;
}

int zd_assembly_is_joint(const zd_assembly *self, int row)
{
    return self->of[row] < self->m && self->given->role[self->of[row]] == ZD_ROLE_JOINT;
}

double zd_assembly_unit_of(const zd_assembly *self, int row, const double *weight)
{
    const zd_sparse_row *J = self->J + row;
    double square = 0;
    for (int j = 0; weight && j < J->count; j++) {
        const double x = J->x[j] / weight[J->column ? J->column[j] : j];
        square += x * x;
    }
    return square > 0 ? zd_assembly_length_of(self, row) / sqrt(square) : 1;
}
