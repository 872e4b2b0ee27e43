/* In a phase without the candidates, x_k = solve(g_k^T, 0) is the answer of the velocities to a unit impulse along row k, which keeps all
 * other constraints (25b), and W = (g_j x_k).
 */
#include "contacts.h"

#include <math.h>
#include <stdio.h>

#include "../linalg/roots.h"
#include "../point/point.h"

static const double CANCELLED_SHARE = 1e-11;      /* share of an impulse that is rounding where constraints cancel it */

static int refuse_start(zd_contacts *it, const zd_group *group, double gap)
{
    snprintf(it->run->outcome.message, ZD_MESSAGE, "contact '%s' must not penetrate at the start: its gap is %.3g", group->name, gap);
    return ZD_BAD_START;
}

/* True if the margin of a group has just become zero. */
static int has_ended(const zd_contacts *it, int g)
{
    const zd_watch *watch = &it->run->watch;
    return watch->acts[watch->events->count - it->phases->full->groups + g];
}

/* True if a slip in two directions has just reversed, as it ends: those of other contacts then end as well. */
static int has_reversed(const zd_contacts *it)
{
    for (int g = 0; g < it->phases->full->groups; g++)
        if (it->phases->full->group[g].rows == 2 && zd_slides(it->phases->state[g]) && has_ended(it, g)) return 1;
    return 0;
}

/* State that a group must enter if its margin has just become zero: a closed row opens, sticking friction slides against its force. */
static signed char find_end(const zd_contacts *it, int g)
{
    const zd_phases *phases = it->phases;
    if (!has_ended(it, g) || phases->state[g] != ZD_CLOSED) return ZD_OPEN;
    if (zd_is_normal(phases->full->group[g].kind)) return ZD_SLIDES_FORWARD;
    return zd_point_multipliers(it->run->motion.point)[phases->full->group[g].first] > 0 ? ZD_SLIDES_FORWARD : ZD_SLIDES_BACKWARD;
}

static const double MISSED_SHARE = 0.01;    /* error of zero where a slip ends, relative to that at the start of the step */
static const double LIMITING_SHARE = 1e-3;  /* smallest share in what limits a distribution of a contact at its bound */

/* The same for friction in two directions, with that of its slip. Where forces are not determined, contacts slide that are at their bounds
 * in the best distribution. */
static signed char find_pair_end(const zd_contacts *it, int g, double *direction)
{
    const zd_phases *phases = it->phases;
    const zd_phase_system *of = phases->present->of;
    const double *lambda = zd_point_multipliers(it->run->motion.point), *f = lambda + phases->full->group[g].first;
    int is_any = has_ended(it, g);
    if (phases->state[g] != ZD_CLOSED) return ZD_OPEN;
    if (of->is_indeterminate) {
        const zd_part_forces *part = zd_phase_part_forces(of, g, lambda);
        for (int i = 0; i < part->forces.contacts; i++) {
            is_any |= part->friction[i] >= 0 && has_ended(it, part->friction[i]);
            if (part->friction[i] == g) f = part->forces.weight[i] > LIMITING_SHARE ? part->forces.force + 3 * i + 1 : NULL;
        }
    }
    if (!is_any || !f) return ZD_OPEN;
    const double size = zd_hypotenuse(f[0], f[1]);
    for (int i = 0; i < 2; i++) direction[i] = size > 0 ? f[i] / size : 0;
    return ZD_SLIDES_FORWARD;
}

/* True if the coordinate along a bounded shape is out of its range, or at an end of it and moves outward. */
static int is_out_of_range(const zd_contacts *it, int g)
{
    const zd_phase_system *of = it->phases->present->of;
    const zd_group *group = it->phases->full->group + g;
    const double within = zd_phase_range_margin(of, g), rounding = ZD_TOUCHING * zd_group_scale(it->phases, group);
    if (fabs(within) > rounding) return within < 0;
    const zd_row_of_C row = zd_phase_row(of, group->range - 1);
    const double rate = zd_row_times(&row, it->phases->at.v) + zd_phase_Phi_t(of)[group->range - 1];
    return zd_phase_Phi(of)[group->range - 1] - group->lower == within ? rate < 0 : rate > 0;
}

/* State of a normal row by its gap and range: ZD_CLOSED if it touches; -1 if the start penetrates. A body within the range of a shape with
 * two sides stays on the side from which it entered; a body that starts on the shape is on its first side. */
static int find_normal_state(const zd_contacts *it, int g, int is_start)
{
    const zd_phases *phases = it->phases;
    const zd_phase_system *of = phases->present->of;
    const zd_group *group = phases->full->group + g;
    const double gap = zd_phase_gap(of, g), tolerance = (is_start ? ZD_PENETRATION : ZD_TOUCHING) * zd_group_scale(phases, group);
    const int opposite = group->opposite - 1;
    const signed char state = it->next[g];
    if (state == ZD_CLOSED || state == ZD_IDLE) return group->range && is_out_of_range(it, g) ? ZD_OPEN : ZD_CLOSED;
    if (group->range && is_out_of_range(it, g)) return ZD_OPEN;
    if (state == ZD_BEHIND) return opposite < 0 && gap > -tolerance ? ZD_OPEN : ZD_BEHIND;
    if (gap > tolerance) return ZD_OPEN;
    if (gap < -tolerance && is_start && (opposite < 0 || zd_phase_gap(of, opposite) < -tolerance)) return -1;
    if (!group->range || gap >= -tolerance) return opposite >= 0 && it->next[opposite] == ZD_CLOSED ? ZD_BEHIND : ZD_CLOSED;
    return ZD_BEHIND;
}

/* Adds a row of a group; friction in two directions has a pair of them. */
static int add_candidate(zd_contacts *it, int g, int component, int normal, double gap)
{
    const zd_group *group = it->phases->full->group + g;
    if (it->count == ZD_MAX_TOUCHING) {
        snprintf(it->run->outcome.message, ZD_MESSAGE, "at most %d contacts and frictions may change at one instant; use fewer contacts",
                 ZD_MAX_TOUCHING);
        return ZD_SEVERAL_MOTIONS;
    }
    it->group[it->count] = g;
    it->gap[it->count] = gap;
    it->sign[it->count] = normal < 0 ? group->sign : 1;
    it->component[it->count] = component;
    it->row[it->count] = (zd_candidate){normal, {group->friction[0], group->friction[1]}, ZD_OPEN, .pair = 0};
    if (normal >= 0 && group->rows == 2) it->row[it->count].pair = (signed char)(1 + component);
    double direction[2] = {0, 0};
    it->ends[it->count] = it->row[it->count].pair ? find_pair_end(it, g, direction) : find_end(it, g);
    it->direction[it->count] = direction[component];
    if (it->has_reversed && it->row[it->count].pair && zd_slides(it->phases->state[g]))
        it->slip_error[it->count] = fmax(MISSED_SHARE * it->phases->present->of->slip_speed[g], it->phases->present->of->slow_slip);
    it->count++;
    return ZD_DONE;
}

static int find_normals(zd_contacts *it, int is_start)
{
    const zd_phases *phases = it->phases;
    const zd_system *full = phases->full;
    int status = ZD_DONE;
    for (int g = 0; g < full->groups && !status; g++) {
        if (!zd_is_normal(full->group[g].kind)) continue;
        const double gap = zd_phase_gap(phases->present->of, g);
        const int state = find_normal_state(it, g, is_start);
        if (state < 0) return refuse_start(it, full->group + g, gap);
        it->next[g] = (signed char)state;
        if (state == ZD_CLOSED) status = add_candidate(it, g, 0, -1, gap);
    }
    it->normals = it->count;
    for (int k = 0; k < it->normals; k++) it->next[it->group[k]] = ZD_OPEN;
    return status;
}

int zd_contacts_find(zd_contacts *it, int is_start)
{
    const zd_system *full = it->phases->full;
    it->has_reversed = has_reversed(it);
    int status = find_normals(it, is_start);
    for (int is_own = 0; is_own < 2; is_own++)      /* friction of contacts, other friction */
        for (int g = 0; g < full->groups && !status; g++) {
            const zd_group *group = full->group + g;
            int normal = is_own ? 0 : it->normals;
            if (group->kind != ZD_FRICTION || (group->normal == 0) != is_own) continue;
            while (normal > 0 && it->group[normal - 1] != group->normal - 1) normal--;
            it->next[g] = ZD_OPEN;
            for (int i = 0; (normal || is_own) && i < group->rows && !status; i++) status = add_candidate(it, g, i, normal, 0);
        }
    return status;
}

int zd_contacts_find_loads(zd_contacts *it)
{
    zd_motion *motion = &it->run->motion;
    int status = ZD_DONE, is_known = 0;
    for (int k = it->normals; k < it->count && !status; k++) {
        if (!zd_candidate_group(it, k)->loads) continue;
        if (!is_known++) status = zd_motion_accelerate(motion);
        if (status) return status;
        zd_rank_find_multipliers(motion->point);
        for (int which = 0; which < 2; which++)
            it->row[k].bound[which] = zd_friction_bound(it->phases->full, it->group[k], which, zd_point_multipliers(motion->point));
    }
    return status;
}

int zd_contacts_allocate(zd_contacts *it)
{
    const size_t n = it->count, nv = it->phases->full->nv, m = it->phases->full->mh + it->phases->full->mn;
    it->memory = zd_allocate((2 * n * nv + n * n + zd_problem_scratch(ZD_MAX_CANDIDATES) + m + 1 + 2 * nv) * sizeof(double));
    it->g = it->memory;
    if (!it->memory) return ZD_NO_MEMORY;
    it->x = it->g + n * nv;
    it->W = it->x + n * nv;
    it->zero = it->W + n * n;
    it->net = it->zero + m + 1;
    it->scratch = it->net + 2 * nv;
    return ZD_DONE;
}

int zd_contacts_find_rows(zd_contacts *it)
{
    zd_phase_system *of = it->phases->present->of;
    const int nv = it->phases->full->nv;
    const int status = zd_phase_evaluate(of, ZD_C | ZD_PHI_T, it->phases->at.t, it->phases->at.p, it->phases->at.v);
    for (int k = 0; k < it->count && !status; k++) {
        const zd_row_of_C row = zd_phase_row(of, zd_candidate_row(it, k));
        double *g = it->g + (size_t)k * nv;
        zd_row_expand(&row, nv, g);
        for (int i = 0; i < nv; i++) g[i] *= it->sign[k];
    }
    return status;
}

/* True if constraint impulses cancel a unit impulse along candidate k to rounding. `net`, `size` (nv,): scratch memory. */
static int is_blocked(const zd_contacts *it, int k, double *net, double *size)
{
    const zd_phase_system *of = it->phases->present->of;
    const int nv = of->full->nv;
    const double *g = it->g + (size_t)k * nv, *lambda = it->run->motion.point->lambda;
    for (int i = 0; i < nv; i++) net[i] = g[i], size[i] = fabs(g[i]);
    for (int row = 0; row < zd_constraints(&of->system); row++) {
        const zd_row_of_C C = zd_phase_row(of, of->row[row]);
        for (int j = 0; j < C.count; j++) {
            const double impulse = C.x[j] * lambda[row];
            net[zd_column(&C, j)] -= impulse, size[zd_column(&C, j)] += fabs(impulse);
        }
    }
    for (int i = 0; i < nv; i++)
        if (fabs(net[i]) > CANCELLED_SHARE * size[i]) return 0;
    return 1;
}

int zd_contacts_find_answers(zd_contacts *it)
{
    zd_motion *motion = &it->run->motion;
    const int n = it->count, nv = motion->system.nv;
    int status = zd_contacts_find_rows(it);
    if (!status) status = zd_motion_factor(motion);
    for (int k = 0; k < n && !status; k++) {
        zd_motion_solve(motion, it->g + (size_t)k * nv, it->zero, it->x + (size_t)k * nv, motion->point->lambda);
        motion->statistics.solves++;
        zd_rank_find_multipliers(motion->point);
        it->is_blocked[k] = is_blocked(it, k, it->net, it->net + nv);
        if (it->row[k].pair == 2) it->is_blocked[k] = it->is_blocked[k - 1] = it->is_blocked[k] && it->is_blocked[k - 1];
    }
    for (int j = 0; j < n && !status; j++)
        for (int k = 0; k < n; k++) it->W[j * n + k] = zd_dot(nv, it->g + (size_t)j * nv, it->x + (size_t)k * nv);
    if (!status) zd_contacts_find_parts(it);
    return status;
}

void zd_contacts_find_velocities(zd_contacts *it)
{
    const int nv = it->phases->full->nv;
    const double *Phi_t = zd_phase_Phi_t(it->phases->present->of);
    for (int k = 0; k < it->count; k++) {
        const zd_group *group = zd_candidate_group(it, k);
        const double rate = Phi_t[zd_candidate_row(it, k)] - (group->kind == ZD_ONE_WAY ? group->value : 0);
        it->w[k] = zd_dot(nv, it->g + (size_t)k * nv, it->phases->at.v) + it->sign[k] * rate;
    }
}

void zd_contacts_apply(zd_contacts *it, const double *z)
{
    const int nv = it->phases->full->nv;
    for (int k = 0; k < it->count; k++) {
        it->is_changed |= z[k] != 0;
        for (int i = 0; i < nv; i++) it->phases->at.v[i] += it->x[(size_t)k * nv + i] * z[k];
    }
}
