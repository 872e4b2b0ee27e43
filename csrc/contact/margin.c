/* Bounds of friction, and margins of groups: what becomes zero where a phase ends. */
#include <math.h>
#include <string.h>

#include "equations.h"
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

/* Friction of two rows that sticks on a normal group; -1: none does. */
static int find_sticking(const zd_phase_system *self, int normal)
{
    for (int g = 0; g < self->full->groups; g++) {
        const zd_group *group = self->full->group + g;
        if (group->kind == ZD_FRICTION && group->rows == 2 && group->normal == normal + 1 && self->state[g] == ZD_CLOSED) return g;
    }
    return -1;
}

/* Adds a row of the full system to those of the share, as its force at `at`. */
static void add_row(int at, int row, int *place, int *rows, int *count)
{
    if (*count == ZD_MAX_NULLS) return;
    place[*count] = at;
    rows[(*count)++] = row;
}

static void find_nulls(const zd_phase_system *self, int count, const int *place, const int *rows, zd_share *share)
{
    double K[ZD_MAX_NULLS * ZD_MAX_NULLS], null[ZD_MAX_NULLS * ZD_MAX_NULLS];
    for (int i = 0; i < count; i++) {
        const zd_row_of_C own = zd_phase_row(self, rows[i]);
        zd_row_expand(&own, self->full->nv, self->known->row);
        for (int j = 0; j < count; j++) {
            const zd_row_of_C other = zd_phase_row(self, rows[j]);
            K[i * count + j] = zd_row_times(&other, self->known->row);
        }
    }
    share->nulls = zd_equations_null_space(count, K, null);
    for (int k = 0; k < share->nulls; k++)
        for (int i = 0; i < count; i++) share->null[k * 3 * share->contacts + place[i]] = null[k * count + i];
}

const zd_share *zd_phase_share(const zd_phase_system *self, const double *lambda)
{
    const zd_system *full = self->full;
    zd_known_terms *known = self->known;
    zd_share *share = known->share;
    int place[ZD_MAX_NULLS] = {0}, rows[ZD_MAX_NULLS] = {0}, count = 0;
    if (known->has_share) return share;
    memset(share, 0, sizeof *share);
    for (int g = 0; g < full->groups && share->contacts < ZD_MAX_SHARES; g++) {
        if (full->group[g].kind != ZD_ONE_SIDED || self->state[g] != ZD_CLOSED) continue;
        const int friction = find_sticking(self, g), at = 3 * share->contacts;
        if (self->slides_in_planes && friction < 0) continue;
        share->force[at] = -full->group[g].sign * lambda[full->group[g].first];
        if (!self->slides_in_planes) add_row(at, full->group[g].first, place, rows, &count);
        for (int i = 0; friction >= 0 && i < 2; i++) {
            share->force[at + 1 + i] = lambda[full->group[friction].first + i];
            add_row(at + 1 + i, full->group[friction].first + i, place, rows, &count);
        }
        share->friction[share->contacts] = friction < 0 ? 0 : full->group[friction].friction[0];
        known->normal[share->contacts] = g;
        known->friction[share->contacts++] = friction;
    }
    find_nulls(self, count, place, rows, share);
    for (int i = 0; i < count; i++)         /* normal forces are those against the gap */
        for (int k = 0; place[i] % 3 == 0 && k < share->nulls; k++)
            share->null[k * 3 * share->contacts + place[i]] *= -full->group[known->normal[place[i] / 3]].sign;
    zd_share_find(share);
    known->has_share = 1;
    return share;
}

/* Normal force of a contact in the share; `otherwise` if it is none of it. */
static double find_shared_normal(const zd_phase_system *self, int index, const double *lambda, double otherwise)
{
    const zd_share *share = zd_phase_share(self, lambda);
    for (int i = 0; i < share->contacts; i++)
        if (self->known->normal[i] == index) return share->force[3 * i];
    return otherwise;
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
    case ZD_CLOSED: {
        const double N = -group->sign * lambda[group->first];
        return fmin(within, self->is_shared && !self->slides_in_planes ? find_shared_normal(self, index, lambda, N) : N);
    }
    case ZD_IDLE: return fmin(within, gap + ZD_TOUCHING * (group->scale > 0 ? group->scale : self->full->length));
    case ZD_BEHIND: return group->opposite ? within : fmin(within, -gap);
    default: return fmax(gap, -within);
    }
}

/* Bound of static friction minus its force; contacts that share a load reach their bounds at once. */
static double find_sticking_margin(const zd_phase_system *self, int index, const double *lambda)
{
    const zd_group *group = self->full->group + index;
    if (group->rows == 1) return find_total_bound(self, index, lambda) - fabs(lambda[group->first]);
    const double bound = zd_friction_bound(self->full, index, 0, lambda);
    if (!self->is_shared) return bound - zd_length_of_two(lambda[group->first], lambda[group->first + 1]);
    return zd_phase_share(self, lambda)->margin;
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
        if (state == ZD_CLOSED && self->is_shared) status = zd_phase_know(self, ZD_C | ZD_PHI, t, p, v);
        else if (state != ZD_CLOSED || group->range)
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
