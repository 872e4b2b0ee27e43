/* Bounds of friction, and margins of groups: what becomes zero where a phase ends. */
#include <math.h>

#include "phase_system.h"

const double *zd_point_multipliers(const zd_point *point)
{
    if (!point->phase) return point->lambda;
    zd_phase_expand(point->phase, point->lambda, point->inputs, point->phase->lambda);
    return point->phase->lambda;
}

double zd_friction_bound(const zd_system *full, int index, int which, const double *lambda)
{
    const zd_group *group = full->group + index;
    return group->friction[which] * zd_friction_load(full, group, lambda + zd_first_load(full, group));
}

int zd_margin_reads_accelerations(const zd_phase_system *self, int index)
{
    return self->full->group[index].kind != ZD_TWO_SIDED && self->state[index] == ZD_CLOSED;
}

/* Bound of static friction of a group, with those of the groups in whose place it sticks. */
static double find_total_bound(const zd_phase_system *self, int index, const double *lambda)
{
    double total = zd_friction_bound(self->full, index, 0, lambda);
    for (int g = 0; g < self->full->groups; g++)
        if (self->full->group[g].kind == ZD_FRICTION && self->state[g] == ZD_IDLE && self->tie[g] == index)
            total += self->tie_factor[g] * zd_friction_bound(self->full, g, 0, lambda);
    return total;
}

int zd_phase_margin(zd_phase_system *self, const zd_point *point, int index, double t, const double *p, const double *v, double *margin)
{
    const zd_group *group = self->full->group + index;
    const signed char state = self->state[index];
    const int first = group->first, is_normal = group->kind == ZD_ONE_SIDED;
    *margin = 1;
    if (group->kind == ZD_TWO_SIDED || state == ZD_IDLE || (!is_normal && state == ZD_OPEN)) return ZD_DONE;
    int status = ZD_DONE;
    if (state == ZD_CLOSED) {
        const double *lambda = zd_point_multipliers(point);
        *margin = is_normal ? -group->sign * lambda[first] : find_total_bound(self, index, lambda) - fabs(lambda[first]);
    } else {
        status = zd_phase_evaluate(self, is_normal ? ZD_PHI : ZD_C | ZD_PHI_T, t, p, v);
        *margin = is_normal ? group->sign * (zd_phase_Phi(self)[first] - group->value) : zd_slip_sign(state) * zd_phase_slip(self, index, v);
    }
    *margin += self->bias[index];
    return status;
}
