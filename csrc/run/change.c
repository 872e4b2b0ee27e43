/* Changes of phase: at an event of a group, at the start, and where a joint is released or joined. All contacts that touch take part.
 *
 * impact           0 <= Lambda, complementary to g v+ + e g v- >= 0; Coulomb's bounds on the impulses of friction, v+ = v- + x Lambda
 * contact          0 <= N, complementary to the acceleration of the gap; sticking or sliding within Coulomb's bounds
 *
 * A contact that approaches slower than the rest speed does not bounce; one that separates slower stays closed if it is pressed together.
 * Friction with a fixed bound, and that by the load of a joint, has no impulse.
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "../linalg/roots.h"
#include "../paths/path.h"
#include "../point/point.h"
#include "../step_limits.h"
#include "contacts.h"

static const double GAIN = 1e-9;            /* energy that an impact may gain by rounding, relative to what it exchanges */
enum { MAX_CHANGES = 30 };                  /* changes of phase at one instant */

/* ---- impacts ---- */

/* Number of candidates whose friction may have impulses: those of contacts, which stand before the others. */
static int find_impulsive(const zd_contacts *it)
{
    int rows = it->normals;
    while (rows < it->count && it->row[rows].normal > 0) rows++;
    return rows;
}

static int make_impact(zd_contacts *it)
{
    const int rows = find_impulsive(it);
    double exchanged = 0, gained = 0;
    int is_any = 0;
    for (int k = 0; k < it->normals; k++) is_any |= it->w[k] < -ZD_STILL * zd_rest_speed(it, k);
    if (!is_any) return ZD_DONE;
    zd_candidate given[ZD_MAX_TOUCHING];
    double direction[ZD_MAX_TOUCHING];
    memcpy(given, it->row, sizeof given);
    memcpy(direction, it->direction, sizeof direction);
    memset(it->direction, 0, sizeof it->direction);
    for (int k = 0; k < rows; k++) {
        const int is_slow = k >= it->normals || fabs(it->w[k]) <= zd_rest_speed(it, k);
        const double e = is_slow ? 0 : zd_candidate_group(it, k)->restitution;
        if (k < it->normals && is_slow) it->omitted[k] = -zd_candidate_group(it, k)->restitution * it->w[k];
        it->b[k] = (1 + e) * it->w[k];
        it->row[k].bound[0] = it->row[k].bound[1];
    }
    int status = zd_contacts_solve(it, rows, "the impact");
    memcpy(it->row, given, sizeof given);
    memcpy(it->direction, direction, sizeof direction);
    if (status) return status;
    for (int k = rows; k < it->count; k++) it->z[k] = 0;
    double before[ZD_MAX_TOUCHING];
    memcpy(before, it->w, sizeof before);
    zd_contacts_apply(it, it->z);
    zd_contacts_find_velocities(it);
    for (int k = 0; k < rows; k++) {
        gained += it->z[k] * (before[k] + it->w[k]) / 2;
        exchanged += fabs(it->z[k] * before[k]);
        const int normal = k < it->normals ? k : it->row[k].normal - 1;
        if (k == normal) it->phases->last.impulse[it->group[k]] += it->z[k];
        it->phases->last.loss[it->group[normal]] -= it->z[k] * (before[k] + it->w[k]) / 2;
    }
    if (gained <= GAIN * exchanged) return ZD_DONE;
    snprintf(it->run->outcome.message, ZD_MESSAGE, "the impact of contact '%s' and of the contacts that act with it must not gain "
             "energy, and gains %.3g J; use equal coefficients of restitution, or less friction", zd_candidate_group(it, 0)->name, gained);
    return ZD_SEVERAL_MOTIONS;
}

/* ---- the phase that follows ---- */

static void classify_friction(zd_contacts *it)
{
    for (int k = it->normals; k < it->count; k++) {
        const int i = k - (it->row[k].pair == 2), is_pair = it->row[k].pair != 0;      /* its first row */
        const double speed = is_pair ? zd_hypotenuse(it->w[i], it->w[i + 1]) : fabs(it->w[k]);
        const int is_still = speed <= fmax(ZD_STILL * zd_rest_speed(it, k), it->slip_error[k]);
        it->row[k].slides = is_still ? it->ends[k] : is_pair || it->w[k] > 0 ? ZD_SLIDES_FORWARD : ZD_SLIDES_BACKWARD;
        it->row[k].is_unknown = (signed char)(is_pair && is_still && it->ends[k] != ZD_OPEN);
        if (is_pair && !is_still) it->direction[k] = it->w[k] / speed;
    }
}

/* Contacts that separate at once take no part. */
static void drop_separating(zd_contacts *it)
{
    for (int k = 0; k < it->normals; k++)
        if (it->w[k] > zd_rest_speed(it, k) || it->ends[k] != ZD_OPEN) it->row[k].slides = ZD_SLIDES_FORWARD;
}

static int find_accelerations(zd_contacts *it)
{
    zd_motion *motion = &it->run->motion;
    const int nv = motion->system.nv;
    int status = zd_stepper_set_state(&it->run->stepper, it->phases->at.t, it->phases->at.p, it->phases->at.v);
    if (!status) status = zd_motion_accelerate(motion);
    if (!status) status = zd_phase_evaluate(it->phases->present->of, ZD_XI, it->phases->at.t, it->phases->at.p, it->phases->at.v);
    const double *xi = zd_phase_xi(it->phases->present->of);
    for (int k = 0; k < it->count && !status; k++)
        it->b[k] = zd_dot(nv, it->g + (size_t)k * nv, motion->point->vdot) - it->sign[k] * xi[zd_candidate_row(it, k)];
    return status;
}

/* Gaps of contacts that close become zero, as by one iteration of (25a): p <- p + A x z */
static int close_gaps(zd_contacts *it)
{
    const zd_motion *motion = &it->run->motion;
    zd_state *at = &it->phases->at;
    zd_point *point = motion->point;
    const int nv = motion->system.nv, nq = motion->system.nq;
    double z[ZD_MAX_TOUCHING], *change = point->force;
    int status = zd_contacts_find_correction(it, it->gap, z);
    zd_clear(nv, change);
    for (int k = 0; k < it->count; k++)
        for (int i = 0; i < nv; i++) change[i] -= it->x[(size_t)k * nv + i] * z[k];
    if (!status && zd_has_A(&motion->system)) status = zd_point_need_times_A(point, 0);
    if (status) return status;
    double *dp = zd_allocate((size_t)nq * sizeof *dp);
    if (!dp) return ZD_NO_MEMORY;
    if (zd_has_A(&motion->system)) zd_point_rate(point, change, dp);
    else zd_copy_all(nv, change, dp);
    zd_correct_position(&motion->system, at->p, dp, at->p);
    zd_release(dp);
    return ZD_DONE;
}

/* Duration of the bounces that are omitted, a geometric series: the first one begins with the speed of the row, and the acceleration towards
 * the shape is that which the contact prevents. */
static void add_omitted_time(zd_contacts *it)
{
    for (int k = 0; k < it->normals; k++) {
        const zd_group *group = zd_candidate_group(it, k);
        const double speed = fmax(it->omitted[k], it->w[k]);
        double prevented = 0;
        for (int j = 0; j < it->count; j++)
            if (j == k || it->row[j].normal == k + 1) prevented += it->W[k * it->count + j] * it->z[j];
        if (group->kind == ZD_ONE_SIDED && it->state[k] == ZD_CLOSED && speed > ZD_STILL * zd_rest_speed(it, k) && prevented > 0)
            it->run->motion.statistics.omitted_bounce_time += 2 * speed / (prevented * (1 - group->restitution));
    }
}

/* Velocities along closed and sticking rows become zero; the second correction removes the rounding of the first. */
static int bring_to_rest(zd_contacts *it)
{
    double z[ZD_MAX_TOUCHING], *energy = &it->run->motion.statistics.omitted_bounce_energy;
    int status = ZD_DONE;
    for (int i = 0; i < 2 && !status; i++) {
        zd_contacts_find_velocities(it);
        status = zd_contacts_find_correction(it, it->w, z);
        for (int k = 0; k < it->count && !status && !i; k++) *energy -= z[k] * it->w[k] / 2;
        if (!status) zd_contacts_apply(it, z);
    }
    return status;
}

static int find_next(zd_contacts *it)
{
    classify_friction(it);
    drop_separating(it);
    int status = find_accelerations(it);
    if (!status && it->count) status = zd_contacts_solve(it, it->count, "the forces");
    if (!status) add_omitted_time(it);
    if (!status && it->normals) status = close_gaps(it);
    if (!status && it->normals) status = zd_contacts_find_rows(it);
    if (!status) status = bring_to_rest(it);
    for (int k = 0; k < it->count; k++) it->next[it->group[k]] = it->state[k];
    return status;
}

/* Two-sided groups that join: their plastic impact, v+ = v- - solve(0, Psi) (25b). */
static int join(zd_contacts *it, int group)
{
    zd_motion *motion = &it->run->motion;
    zd_point *point = motion->point;
    const int m = zd_constraints(&motion->system);
    double kinetic = 0, *Psi = point->rhs, *x = point->force;
    int status = zd_point_need(point, ZD_M | ZD_C | ZD_PHI_T);
    if (!status) status = zd_point_need_times_C(point);
    if (status || !m) return status;
    kinetic = zd_point_kinetic(point);
    zd_point_velocity_violation(point, Psi);
    status = zd_motion_factor(motion);
    if (status) return status;
    zd_motion_solve(motion, NULL, Psi, x, point->lambda);
    zd_correct_velocity(&motion->system, it->phases->at.v, x, it->phases->at.v);
    zd_point_move_velocity(point, it->phases->at.v);
    it->phases->last.loss[group] = kinetic - zd_point_kinetic(point);
    it->is_changed = 1;
    return ZD_DONE;
}

static int find_kinetic(zd_run *run, double *kinetic)
{
    const int status = zd_point_need(run->motion.point, ZD_M);
    if (!status) *kinetic = zd_point_kinetic(run->motion.point);
    return status;
}

static int change(zd_contacts *it, int joining, int is_start)
{
    zd_run *run = it->run;
    zd_phases *phases = it->phases;
    double before = 0, after = 0;
    zd_phases_save_state(run);
    int status = zd_phase_evaluate(phases->present->of, ZD_PHI | ZD_C | ZD_PHI_T, phases->at.t, phases->at.p, phases->at.v);
    if (!status) status = zd_contacts_find(it, is_start);
    if (!status) status = zd_contacts_find_loads(it);
    if (!status) status = zd_contacts_allocate(it);
    if (!status) status = zd_phase_enter(run, it->next, 1);
    if (!status) status = find_kinetic(run, &before);
    if (!status && joining >= 0) status = join(it, joining);
    if (!status) status = zd_contacts_find_answers(it);
    if (status) return status;
    zd_contacts_find_velocities(it);
    status = make_impact(it);
    if (!status) status = find_next(it);
    if (!status) status = zd_contacts_enter(it);
    if (!status) status = find_kinetic(run, &after);
    phases->last.energy = it->is_changed ? after - before : 0;
    return status;
}

/* True after MAX_CHANGES changes of phase at one instant, to the rounding of the time; near t = 0 to that of the duration. */
static int is_too_often(zd_phases *phases, const zd_run *run)
{
    const double t = run->stepper.t, size = fmax(fabs(t), fmin(1, run->goal.end - run->settings.t0));
    phases->changes = fabs(t - phases->t_changes) <= ZD_TIME_RESOLUTION * size ? phases->changes + 1 : 1;
    phases->t_changes = t;
    return phases->changes > MAX_CHANGES;
}

int zd_phases_change(zd_run *run, const signed char *wanted, int is_start)
{
    zd_phases *phases = run->phases;
    const zd_system *full = phases->full;
    if (is_too_often(phases, run)) return ZD_CHATTERS;
    zd_contacts *it = zd_allocate(sizeof *it + full->groups);
    if (!it) return ZD_NO_MEMORY;
    it->run = run, it->phases = phases, it->next = (signed char *)(it + 1);
    memcpy(it->next, phases->state, full->groups);
    int joining = -1;
    for (int g = 0; wanted && g < full->groups; g++) {
        if (full->group[g].kind != ZD_TWO_SIDED) continue;
        if (wanted[g] == ZD_CLOSED && it->next[g] != ZD_CLOSED) joining = g;
        it->next[g] = wanted[g];
    }
    memset(phases->last.loss, 0, full->groups * sizeof *phases->last.loss);
    memset(phases->last.impulse, 0, full->groups * sizeof *phases->last.impulse);
    int status = is_start ? ZD_DONE : zd_event_jumps_begin(run);
    if (!status) status = change(it, joining, is_start);
    if (!status) {
        if (!is_start) zd_event_jumps_finish(run);
        memcpy(phases->state, phases->present->of->state, full->groups);
        phases->last.count++;
        phases->last.t = run->stepper.t;
        if (phases->last.energy != 0) zd_motion_add_jump(&run->motion, run->stepper.t, phases->last.energy);
        if (!is_start) run->tally.start_saved = run->settings.t_eval != NULL;
    }
    zd_release(it->memory);
    zd_release(it);
    return status;
}

const zd_transition *zd_run_transition(const zd_run *run) { return run->phases ? &run->phases->last : NULL; }
