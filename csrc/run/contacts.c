/* In a phase without the candidates, x_k = solve(g_k^T, 0) is the answer of the velocities to a unit impulse along row k, which keeps all
 * other constraints (25b), and W = (g_j x_k).
 */
#include "contacts.h"

#include <math.h>
#include <stdio.h>

#include "../point/point.h"

static const double TOUCHING = 1e-10;       /* gap of contacts that take part, relative to the characteristic length */

static int refuse_start(zd_contacts *it, const zd_group *group, double gap)
{
    snprintf(it->run->outcome.message, ZD_MESSAGE, "the start must not penetrate contact '%s': its gap is %.3g", group->name, gap);
    return ZD_BAD_START;
}

/* State that a group must enter if its margin has just become zero: a closed row opens, sticking friction slides against its force. */
static signed char find_end(const zd_contacts *it, int g)
{
    const zd_watch *watch = &it->run->watch;
    const zd_phases *phases = it->phases;
    const int event = watch->events->count - phases->full->groups + g;
    if (!watch->acts[event] || phases->state[g] != ZD_CLOSED) return ZD_OPEN;
    if (phases->full->group[g].kind == ZD_ONE_SIDED) return ZD_SLIDES_FORWARD;
    return zd_point_multipliers(it->run->motion.point)[phases->full->group[g].first] > 0 ? ZD_SLIDES_FORWARD : ZD_SLIDES_BACKWARD;
}

int zd_contacts_find(zd_contacts *it, int is_start)
{
    const zd_phases *phases = it->phases;
    const zd_system *full = phases->full;
    const double *Phi = zd_phase_Phi(phases->present->of);
    for (int pass = 0; pass < 3; pass++)        /* normal rows, their friction, other friction */
        for (int g = 0; g < full->groups; g++) {
            const zd_group *group = full->group + g;
            if (group->kind != (pass ? ZD_FRICTION : ZD_ONE_SIDED)) continue;
            int normal = -1;
            double gap = 0;
            if (!pass) {
                gap = group->sign * (Phi[group->first] - group->value);
                if (is_start && gap < -ZD_PENETRATION * zd_group_scale(phases, group)) return refuse_start(it, group, gap);
                if (it->next[g] == ZD_OPEN && gap > (is_start ? ZD_PENETRATION : TOUCHING) * zd_group_scale(phases, group)) continue;
            } else if (group->normal) {
                if (pass > 1) continue;
                for (normal = it->normals; normal > 0 && it->group[normal - 1] != group->normal - 1;) normal--;
                if (!normal) continue;
            } else if (pass == 1) continue;
            else normal = 0;
            if (it->count == ZD_MAX_CANDIDATES) {
                snprintf(it->run->outcome.message, ZD_MESSAGE, "at most %d contacts and frictions may change at one instant",
                         ZD_MAX_CANDIDATES);
                return ZD_SEVERAL_MOTIONS;
            }
            it->group[it->count] = g;
            it->gap[it->count] = gap;
            it->sign[it->count] = pass ? 1 : group->sign;
            it->row[it->count] = (zd_candidate){normal, {group->friction[0], group->friction[1]}, ZD_OPEN};
            it->ends[it->count] = find_end(it, g);
            it->count++;
            it->next[g] = ZD_OPEN;
            it->normals += !pass;
        }
    return ZD_DONE;
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
    it->memory = zd_allocate((2 * n * nv + n * n + zd_problem_scratch((int)n) + m + 1) * sizeof(double));
    it->g = it->memory;
    if (!it->memory) return ZD_NO_MEMORY;
    it->x = it->g + n * nv;
    it->W = it->x + n * nv;
    it->zero = it->W + n * n;
    it->scratch = it->zero + m + 1;
    return ZD_DONE;
}

int zd_contacts_find_answers(zd_contacts *it)
{
    zd_motion *motion = &it->run->motion;
    zd_phase_system *of = it->phases->present->of;
    const int n = it->count, nv = motion->system.nv;
    int status = zd_phase_evaluate(of, ZD_C | ZD_PHI_T, it->phases->at.t, it->phases->at.p, it->phases->at.v);
    if (!status) status = zd_motion_factor(motion);
    for (int k = 0; k < n && !status; k++) {
        const zd_row_of_C row = zd_phase_row(of, zd_candidate_group(it, k)->first);
        double *g = it->g + (size_t)k * nv;
        zd_row_expand(&row, nv, g);
        for (int i = 0; i < nv; i++) g[i] *= it->sign[k];
        zd_motion_solve(motion, g, it->zero, it->x + (size_t)k * nv, motion->point->lambda);
        motion->statistics.solves++;
    }
    for (int j = 0; j < n && !status; j++)
        for (int k = 0; k < n; k++) it->W[j * n + k] = zd_dot(nv, it->g + (size_t)j * nv, it->x + (size_t)k * nv);
    return status;
}

void zd_contacts_find_velocities(zd_contacts *it)
{
    const int nv = it->phases->full->nv;
    const double *Phi_t = zd_phase_Phi_t(it->phases->present->of);
    for (int k = 0; k < it->count; k++)
        it->w[k] = zd_dot(nv, it->g + (size_t)k * nv, it->phases->at.v) + it->sign[k] * Phi_t[zd_candidate_group(it, k)->first];
}

void zd_contacts_apply(zd_contacts *it, const double *z)
{
    const int nv = it->phases->full->nv;
    for (int k = 0; k < it->count; k++) {
        it->is_changed |= z[k] != 0;
        for (int i = 0; i < nv; i++) it->phases->at.v[i] += it->x[(size_t)k * nv + i] * z[k];
    }
}

int zd_contacts_solve(zd_contacts *it, int rows, const char *what)
{
    int opens = 0;
    for (int k = 0; k < rows; k++) opens |= it->ends[k] != ZD_OPEN;
    zd_contact_problem problem = {rows, it->row, it->W, it->b, opens, it->state, it->tie, it->factor, it->z, it->after, it->scratch};
    double W[ZD_MAX_CANDIDATES * ZD_MAX_CANDIDATES];
    if (rows < it->count) {
        for (int j = 0; j < rows; j++)
            for (int k = 0; k < rows; k++) W[j * rows + k] = it->W[j * it->count + k];
        problem.W = W;
    }
    const int found = zd_problem_solve(&problem);
    if (found == 1) return ZD_DONE;
    const char *how = found < 0 ? "too many contacts change at one instant: they must be fewer"
                    : !found ? rows > it->normals ? "no solution exists, as in Painleve's paradox: friction must be smaller"
                                                  : "no solution exists: drives and joints must allow the bodies to stop"
                    : "several solutions exist, as in Painleve's paradox: friction must be smaller";
    snprintf(it->run->outcome.message, ZD_MESSAGE, "%s of contact '%s' and those that act with it: %s", what, zd_candidate_group(it, 0)->name,
             how);
    return ZD_SEVERAL_MOTIONS;
}
