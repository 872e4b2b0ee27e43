/* Bounds of friction, and margins of groups: what becomes zero where a phase ends. */
#include <math.h>
#include <string.h>

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

/* Evaluates terms that are not known yet at a state: all groups read those of one evaluation. */
static int evaluate_once(zd_phase_system *self, int want, double t, const double *p, const double *v)
{
    const size_t size_p = self->full->nq * sizeof *p, size_v = self->full->nv * sizeof *v;
    int known = self->known;
    if (known && (t != self->known_t || memcmp(p, self->known_p, size_p) || memcmp(v, self->known_v, size_v))) known = 0;
    if ((known & want) == want) return ZD_DONE;
    const int status = zd_phase_evaluate(self, want, t, p, v);
    if (status) return status;
    self->known = known | want;
    self->known_t = t;
    memcpy(self->known_p, p, size_p);
    memcpy(self->known_v, v, size_v);
    return ZD_DONE;
}

/* Margin of a one-sided group by its state. Out of the range of its shape a closed group opens, and an open one cannot close. A shape with
 * one side may be passed from behind. */
static double find_normal_margin(const zd_phase_system *self, int index, const double *v, const double *lambda)
{
    const zd_group *group = self->full->group + index;
    const double within = zd_phase_range_margin(self, index);
    const double gap = group->kind == ZD_ONE_WAY ? group->sign * (zd_phase_slip(self, index, v) - group->value) : zd_phase_gap(self, index);
    switch (self->state[index]) {
    case ZD_CLOSED: return fmin(within, -group->sign * lambda[group->first]);
    case ZD_IDLE: return fmin(within, gap + ZD_TOUCHING * (group->scale > 0 ? group->scale : self->full->length));
    case ZD_BEHIND: return group->opposite ? within : fmin(within, -gap);
    default: return fmax(gap, -within);
    }
}

int zd_phase_margin(zd_phase_system *self, const zd_point *point, int index, double t, const double *p, const double *v, double *margin)
{
    const zd_group *group = self->full->group + index;
    const signed char state = self->state[index];
    const int is_normal = zd_is_normal(group->kind);
    *margin = 1;
    if (group->kind == ZD_TWO_SIDED || (!is_normal && (state == ZD_OPEN || state == ZD_IDLE))) return ZD_DONE;
    const double *lambda = state == ZD_CLOSED ? zd_point_multipliers(point) : NULL;
    int status = ZD_DONE;
    if (is_normal) {
        if (state != ZD_CLOSED || group->range)
            status = evaluate_once(self, group->kind == ZD_ONE_WAY ? ZD_C | ZD_PHI_T : ZD_PHI, t, p, v);
        *margin = find_normal_margin(self, index, v, lambda);
    } else if (state == ZD_CLOSED) *margin = find_total_bound(self, index, lambda) - fabs(lambda[group->first]);
    else {
        status = evaluate_once(self, ZD_C | ZD_PHI_T, t, p, v);
        *margin = zd_slip_sign(state) * zd_phase_slip(self, index, v);
    }
    *margin += self->bias[index];
    return status;
}
