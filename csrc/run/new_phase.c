/* Entry of the phase that a change leads to. Forces that read loads and reactions are known only there, so that they may change states of
 * contacts once more.
 */
#include <math.h>
#include <stdio.h>

#include "../linalg/roots.h"
#include "../linalg/small.h"
#include "../point/point.h"
#include "contacts.h"

static const double EXCESS_SHARE = 1e-9;    /* force beyond its bound, relative to the largest one, that is rounding */
static const double EXCESS = 2e-15;         /* the same where there are none, in characteristic lengths */

enum { MAX_SOLUTIONS = 8 };                 /* phases that are tried where laws read reactions */

/* Enters the next phase, and passes on to it what its state does not say. */
static int enter(const zd_contacts *it)
{
    const int status = zd_phase_enter(it->run, it->next, 1);
    zd_phase_system *of = it->phases->present->of;
    if (status) return status;
    of->is_indeterminate = it->free_forces > 0;
    of->has_ties = 0;
    for (int k = 0; k < it->count; k++) {
        of->part[it->group[k]] = it->part[k];
        of->tie[it->group[k]] = it->tie[k] < 0 ? -1 : it->group[it->tie[k]];
        of->tie_factor[it->group[k]] = it->factor[k];
        of->has_ties |= it->tie[k] >= 0;
        if (it->row[k].pair) of->direction[2 * it->group[k] + it->component[k]] = it->direction[k];
        if (it->row[k].pair != 1) continue;
        const double *W = it->W + (size_t)k * (it->count + 1), between = sqrt(2) * W[1];
        of->mobility[it->group[k]] = it->row[k].bound[1] * zd_hypotenuse(between, zd_hypotenuse(W[0], W[it->count + 1]));
    }
    return zd_phase_enter(it->run, it->next, 0);
}

static int refuse_laws(const zd_contacts *it, int k)
{
    snprintf(it->run->outcome.message, ZD_MESSAGE,
             "the state of '%s' must agree with the forces that laws read: none of the states tried does", zd_candidate_group(it, k)->name);
    return ZD_SEVERAL_MOTIONS;
}

/* Friction that exceeds its bound in the present phase slides against its force, with that in whose place it sticks, and a contact that is
 * pulled opens; 0: it is within its bounds. */
static int correct_state(zd_contacts *it, int k)
{
    const zd_phases *phases = it->phases;
    const double *lambda = zd_point_multipliers(it->run->motion.point), *f = lambda + zd_candidate_group(it, k)->first;
    const double rounding = EXCESS_SHARE * zd_max_abs(zd_constraints(phases->full), lambda) + EXCESS * phases->length;
    signed char *next = it->next;
    if (next[it->group[k]] != ZD_CLOSED || !(phases->present->of->bias[it->group[k]] > rounding)) return 0;
    if (k < it->normals) next[it->group[k]] = ZD_OPEN;
    if (it->row[k].pair) {
        const double size = zd_hypotenuse(f[0], f[1]);
        for (int i = 0; i < 2; i++) it->direction[k + i] = size > 0 ? f[i] / size : 0;
        next[it->group[k]] = ZD_SLIDES_FORWARD;
    }
    for (int i = it->normals; i < it->count; i++)
        if (it->row[i].normal == k + 1) next[it->group[i]] = ZD_OPEN;
        else if (!it->row[k].pair && k >= it->normals && (i == k || it->tie[i] == k)) {
            next[it->group[i]] = (f[0] > 0) == (i == k || it->factor[i] > 0) ? ZD_SLIDES_FORWARD : ZD_SLIDES_BACKWARD;
            it->tie[i] = -1;
        }
    return 1;
}

/* Acceleration along a candidate in the present phase, of which xi is known. */
static double find_acceleration(const zd_contacts *it, int k)
{
    const zd_phase_system *of = it->phases->present->of;
    const double *vdot = it->run->motion.point->vdot;
    return zd_dot(of->full->nv, it->g + (size_t)k * of->full->nv, vdot) - it->sign[k] * zd_phase_xi(of)[zd_candidate_row(it, k)];
}

/* True if friction that slides from rest in the present phase is accelerated backward there, or an open contact is closed. */
static int is_driven_back(const zd_contacts *it, int k)
{
    const int first = k - (it->row[k].pair == 2);
    double along = 0, size = 0;
    if (k < it->normals ? it->next[it->group[k]] != ZD_OPEN : !zd_slides(it->next[it->group[k]])) return 0;
    for (int i = first; i <= first + (it->row[k].pair != 0); i++) {
        const double a = find_acceleration(it, i);
        if (fabs(it->w[i]) > ZD_STILL * zd_rest_speed(it, i)) return 0;
        along += a * (k < it->normals ? 1 : it->row[k].pair ? it->direction[i] : zd_slip_sign(it->next[it->group[k]]));
        size = fmax(size, fabs(it->b[i]));
    }
    return along < -EXCESS_SHARE * size;
}

/* `next` by the forces of laws in the present phase, as they are constant; then in the phase that follows, until it is the same one. */
static int solve_again(zd_contacts *it, int *is_same)
{
    const double *lambda = zd_point_multipliers(it->run->motion.point);
    int status = zd_phase_evaluate(it->phases->present->of, ZD_XI, it->phases->at.t, it->phases->at.p, it->phases->at.v);
    for (int k = 0; k < it->count; k++) it->z[k] = -it->sign[k] * lambda[zd_candidate_row(it, k)];
    for (int k = 0; k < it->count && !status; k++)
        it->b[k] = find_acceleration(it, k) - zd_dot(it->count, it->W + (size_t)k * it->count, it->z);
    if (!status) status = zd_contacts_solve(it, it->count, "the forces");
    *is_same = 1;
    for (int k = 0; k < it->count && !status; k++) {
        *is_same &= it->next[it->group[k]] == it->state[k];
        it->next[it->group[k]] = it->state[k];
    }
    return status || *is_same ? status : enter(it);
}

/* Forces that read loads and reactions are known only in the new phase, so that its states may change there. */
int zd_contacts_enter(zd_contacts *it)
{
    const int reads = it->phases->full->reading != NULL;
    int status = enter(it), is_same = !reads;
    for (int i = 0; i < MAX_SOLUTIONS && !status && !is_same; i++) status = solve_again(it, &is_same);
    for (int k = 0; k < it->count && !status; k++)
        if ((reads || zd_candidate_group(it, k)->loads) && correct_state(it, k)) status = enter(it);
    if (!status && reads) status = zd_phase_evaluate(it->phases->present->of, ZD_XI, it->phases->at.t, it->phases->at.p, it->phases->at.v);
    for (int k = 0; k < it->count && !status && reads; k++)
        if (is_driven_back(it, k) || correct_state(it, k)) status = refuse_laws(it, k);
    return status;
}
