/* Bounds of friction, and margins of groups: what becomes zero where a phase ends. */
#include <math.h>
#include <string.h>

#include "../linalg/roots.h"
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

/* Friction in two directions that sticks at a normal group; -1: none. */
static int find_sticking(const zd_phase_system *self, int normal)
{
    for (int g = 0; g < self->full->groups; g++) {
        const zd_group *group = self->full->group + g;
        if (group->kind == ZD_FRICTION && group->rows == 2 && group->normal == normal + 1 && self->state[g] == ZD_CLOSED) return g;
    }
    return -1;
}

/* Products of rows of the full system, each times its sign. */
static void find_products(const zd_phase_system *self, int count, const int *rows, const double *sign, double *K)
{
    for (int i = 0; i < count; i++) {
        const zd_row_of_C own = zd_phase_row(self, rows[i]);
        zd_row_expand(&own, self->full->nv, self->known->row);
        for (int j = 0; j < count; j++) {
            const zd_row_of_C other = zd_phase_row(self, rows[j]);
            K[i * count + j] = sign[i] * sign[j] * zd_row_times(&other, self->known->row);
        }
    }
}

const zd_distribution *zd_phase_distribution(const zd_phase_system *self, const double *lambda)
{
    const zd_system *full = self->full;
    const int with_normals = !self->has_sliding_pairs;
    zd_known_terms *known = self->known;
    zd_distribution *forces = known->distribution;
    int rows[ZD_MAX_FREE] = {0}, count = 0;
    double sign[ZD_MAX_FREE] = {0}, K[ZD_MAX_FREE * ZD_MAX_FREE];
    if (known->has_distribution) return forces;
    forces->contacts = forces->components = 0;
    for (int g = 0; g < full->groups; g++) {
        const zd_group *normal = full->group + g;
        if (normal->kind != ZD_ONE_SIDED || self->state[g] != ZD_CLOSED) continue;
        const int friction = find_sticking(self, g), sticks = friction >= 0, contact = forces->contacts;
        if (!with_normals && !sticks) continue;
        zd_distribution_add(forces, -normal->sign * lambda[normal->first], with_normals,
                            sticks ? lambda + full->group[friction].first : NULL, sticks ? full->group[friction].friction[0] : 0);
        if (forces->contacts == contact) break;
        known->normal[contact] = g, known->friction[contact] = friction;
        if (with_normals) sign[count] = -normal->sign, rows[count++] = normal->first;
        for (int i = 0; i < 2 * sticks; i++) sign[count] = 1, rows[count++] = full->group[friction].first + i;
    }
    find_products(self, count, rows, sign, K);
    zd_distribution_find(forces, K);
    known->has_distribution = 1;
    return forces;
}

/* Normal force of a contact in the distribution; `otherwise` if it has no part in it. */
static double find_distributed_normal(const zd_phase_system *self, int index, const double *lambda, double otherwise)
{
    const zd_distribution *forces = zd_phase_distribution(self, lambda);
    for (int i = 0; i < forces->contacts; i++)
        if (self->known->normal[i] == index) return forces->force[3 * i];
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
        return fmin(within, self->is_indeterminate && !self->has_sliding_pairs ? find_distributed_normal(self, index, lambda, N) : N);
    }
    case ZD_IDLE: return fmin(within, gap + ZD_TOUCHING * (group->scale > 0 ? group->scale : self->full->length));
    case ZD_BEHIND: return group->opposite ? within : fmin(within, -gap);
    default: return fmax(gap, -within);
    }
}

/* Bound of static friction minus its force; of forces that are not determined, that of their best distribution. */
static double find_sticking_margin(const zd_phase_system *self, int index, const double *lambda)
{
    const zd_group *group = self->full->group + index;
    if (group->rows == 1) return find_total_bound(self, index, lambda) - fabs(lambda[group->first]);
    const double bound = zd_friction_bound(self->full, index, 0, lambda);
    if (!self->is_indeterminate) return bound - zd_hypotenuse(lambda[group->first], lambda[group->first + 1]);
    return zd_phase_distribution(self, lambda)->margin;
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
        if (state == ZD_CLOSED && self->is_indeterminate) status = zd_phase_need(self, ZD_C | ZD_PHI, t, p, v);
        else if (state != ZD_CLOSED || group->range)
            status = zd_phase_need(self, group->kind == ZD_ONE_WAY ? ZD_C | ZD_PHI_T : ZD_PHI, t, p, v);
        *margin = find_normal_margin(self, index, v, lambda);
    } else if (state == ZD_CLOSED) {
        if (self->is_indeterminate && group->rows == 2) status = zd_phase_need(self, ZD_C, t, p, v);
        *margin = find_sticking_margin(self, index, lambda);
    } else {
        status = zd_phase_need(self, ZD_C | ZD_PHI_T, t, p, v);
        *margin = find_slip_margin(self, index, v);
    }
    *margin += self->bias[index];
    return status;
}
