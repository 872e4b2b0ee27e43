/* Bounds of friction, and margins of groups: what becomes zero where a phase ends. */
#include <math.h>
#include <string.h>

#include "../linalg/roots.h"
#include "phase_system.h"

static const double TURNING_SHARE = 0.4;    /* turning slip, relative to its change by friction in a step */

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

/* Friction in two directions of a normal group; -1: none. */
static int find_friction(const zd_phase_system *self, int normal)
{
    for (int g = 0; g < self->full->groups; g++)
        if (self->full->group[g].normal == normal + 1 && self->full->group[g].rows == 2) return g;
    return -1;
}

static double find_product(const zd_phase_system *self, int row, int other)
{
    const zd_row_of_C one = zd_phase_row(self, row), two = zd_phase_row(self, other);
    zd_row_expand(&one, self->full->nv, self->known->row);
    return zd_row_times(&two, self->known->row);
}

/* Closed one-sided groups of the same part as the first one. */
static int list_part(const zd_phase_system *self, int first, int *normal)
{
    int count = 0;
    for (int g = 0; g < self->full->groups && count < ZD_MAX_DISTRIBUTED; g++)
        if (self->full->group[g].kind == ZD_ONE_SIDED && self->state[g] == ZD_CLOSED && self->part[g] == self->part[first])
            normal[count++] = g;
    return count;
}

static void find_part(const zd_phase_system *self, int first, const double *lambda, zd_part_forces *to)
{
    const zd_group *group = self->full->group;
    int normals[ZD_MAX_DISTRIBUTED], rows[ZD_MAX_FREE] = {0}, count = 0, slides = 0;
    const int contacts = list_part(self, first, normals);
    double sign[ZD_MAX_FREE] = {0}, K[ZD_MAX_FREE * ZD_MAX_FREE];
    for (int i = 0; i < contacts; i++) {
        const int friction = find_friction(self, normals[i]);
        slides |= friction >= 0 && zd_slides(self->state[friction]);
    }
    to->forces.contacts = to->forces.components = 0;
    for (int i = 0; i < contacts; i++) {
        const zd_group *normal = group + normals[i];
        const int g = find_friction(self, normals[i]), sticks = g >= 0 && self->state[g] == ZD_CLOSED, contact = to->forces.contacts;
        if (slides && !sticks) continue;
        zd_distribution_add(&to->forces, -normal->sign * lambda[normal->first], !slides, sticks ? lambda + group[g].first : NULL,
                            sticks ? group[g].friction[0] : 0);
        if (to->forces.contacts == contact) break;
        to->normal[contact] = normals[i], to->friction[contact] = sticks ? g : -1;
        if (!slides) sign[count] = -normal->sign, rows[count++] = normal->first;
        for (int k = 0; k < 2 * sticks; k++) sign[count] = 1, rows[count++] = group[g].first + k;
    }
    for (int i = 0; i < count; i++)
        for (int k = 0; k < count; k++) K[i * count + k] = sign[i] * sign[k] * find_product(self, rows[i], rows[k]);
    zd_distribution_find(&to->forces, K);
}

const zd_part_forces *zd_phase_part_forces(const zd_phase_system *self, int index, const double *lambda)
{
    const zd_group *group = self->full->group + index;
    const int normal = group->normal ? group->normal - 1 : index;
    zd_known_terms *known = self->known;
    for (int k = 0; k < known->parts; k++)
        for (int i = 0; i < known->part[k].forces.contacts; i++)
            if (known->part[k].normal[i] == normal) return known->part + k;
    find_part(self, normal, lambda, known->part + known->parts);
    return known->part + known->parts++;
}

/* Normal force of a closed contact in the distribution; `otherwise` if it has no part in it. */
static double find_distributed_normal(const zd_phase_system *self, int index, const double *lambda, double otherwise)
{
    const zd_part_forces *part = zd_phase_part_forces(self, index, lambda);
    for (int i = 0; i < part->forces.contacts; i++)
        if (part->normal[i] == index) return part->forces.force[3 * i];
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
        return fmin(within, self->is_indeterminate && group->kind == ZD_ONE_SIDED ? find_distributed_normal(self, index, lambda, N) : N);
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
    if (group->rows == 1) return zd_friction_room(self, index, lambda);
    const double bound = zd_friction_bound(self->full, index, 0, lambda);
    if (!self->is_indeterminate) return bound - zd_hypotenuse(lambda[group->first], lambda[group->first + 1]);
    return zd_phase_part_forces(self, index, lambda)->forces.margin;
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

void zd_phase_update_turning_slip(const zd_phase_system *self, const zd_settings *settings, const double *margin)
{
    const zd_group *group = self->full->group;
    const double step = settings->steps == ZD_FIXED_STEPS ? settings->step : 0;
    for (int g = 0; self->has_sliding_pairs && g < self->full->groups; g++) {
        double sum = 0;
        for (int i = 0; i < self->full->groups; i++)
            if (group[i].normal && group[i].rows == 2 && zd_slides(self->state[i]) && self->part[i] == self->part[g])
                sum += self->mobility[i] * fmax(0, margin[group[i].normal - 1]);
        self->turning_slip[g] = TURNING_SHARE * step * sum;
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
