/* Bounds of friction, and margins of groups: what becomes zero where a phase ends. */
#include <math.h>
#include <string.h>

#include "phase_system.h"

const double *zd_point_multipliers(const zd_point *point)
{
    if (!point->phase) return point->lambda;
    zd_phase_expand(point->phase, point->t, point->p, point->v, point->lambda, point->inputs, point->phase->lambda);
    return point->phase->lambda;
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

/* Margin of a one-sided group by its state. Out of the range of its shape a closed group opens, and an open one cannot close. A shape with
 * one side may be passed from behind. */
static double find_normal_margin(const zd_phase_system *self, int index, const double *v, const double *lambda)
{
    const zd_group *group = self->full->group + index;
    const double within = zd_phase_range_margin(self, index);
    double slip[2], gap;
    if (group->kind == ZD_ONE_WAY) zd_phase_slip(self, index, v, slip), gap = group->sign * (slip[0] - group->value);
    else gap = zd_phase_gap(self, index);
    switch (self->state[index]) {
    case ZD_CLOSED: return fmin(within, -group->sign * lambda[group->first]);
    case ZD_IDLE: return fmin(within, gap + ZD_TOUCHING * (group->scale > 0 ? group->scale : self->full->length));
    case ZD_BEHIND: return group->opposite ? within : fmin(within, -gap);
    default: return fmax(gap, -within);
    }
}

void zd_phase_share(const zd_phase_system *self, const double *lambda, zd_share *share, int *group)
{
    const zd_system *full = self->full;
    const int nv = full->nv;
    double K[4 * ZD_MAX_PAIRS * ZD_MAX_PAIRS];
    share->pairs = 0;
    for (int g = 0; g < full->groups && share->pairs < ZD_MAX_PAIRS; g++) {
        if (full->group[g].kind != ZD_FRICTION || full->group[g].rows != 2 || self->state[g] != ZD_CLOSED) continue;
        group[share->pairs] = g;
        share->bound[share->pairs] = zd_friction_bound(full, g, 0, lambda);
        for (int i = 0; i < 2; i++) share->f[2 * share->pairs + i] = lambda[full->group[g].first + i];
        share->pairs++;
    }
    double *row = self->known->row;
    for (int i = 0; i < 2 * share->pairs; i++) {
        const zd_row_of_C own = zd_phase_row(self, full->group[group[i / 2]].first + i % 2);
        zd_row_expand(&own, nv, row);
        for (int j = 0; j < 2 * share->pairs; j++) {
            const zd_row_of_C other = zd_phase_row(self, full->group[group[j / 2]].first + j % 2);
            K[i * 2 * share->pairs + j] = zd_row_times(&other, row);
        }
    }
    zd_share_find(share, K);
}

/* Bound of static friction minus its force; contacts that share a load reach their bounds at once. */
static double find_sticking_margin(const zd_phase_system *self, int index, const double *lambda)
{
    const zd_group *group = self->full->group + index;
    if (group->rows == 1) return find_total_bound(self, index, lambda) - fabs(lambda[group->first]);
    const double bound = zd_friction_bound(self->full, index, 0, lambda);
    if (!self->is_shared) return bound - hypot(lambda[group->first], lambda[group->first + 1]);
    zd_share share;
    int of[ZD_MAX_PAIRS];
    zd_phase_share(self, lambda, &share, of);
    return bound * (1 - share.factor);
}

/* Slip velocity along the direction of slip, which changes its sign where friction begins to stick. */
static double find_slip_margin(const zd_phase_system *self, int index, const double *v)
{
    const double *d = self->direction + 2 * index;
    double slip[2];
    zd_phase_slip(self, index, v, slip);
    if (self->full->group[index].rows == 1) return zd_slip_sign(self->state[index]) * slip[0];
    return d[0] * slip[0] + d[1] * slip[1];
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
            status = zd_phase_know(self, group->kind == ZD_ONE_WAY ? ZD_C | ZD_PHI_T : ZD_PHI, t, p, v);
        *margin = find_normal_margin(self, index, v, lambda);
    } else if (state == ZD_CLOSED) {
        if (self->is_shared && group->rows == 2) status = zd_phase_know(self, ZD_C, t, p, v);
        *margin = find_sticking_margin(self, index, lambda);
    } else {
        status = zd_phase_know(self, ZD_C | ZD_PHI_T, t, p, v);
        *margin = find_slip_margin(self, index, v);
    }
    *margin += self->bias[index];
    return status;
}
