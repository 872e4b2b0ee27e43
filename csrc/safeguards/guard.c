/* Acceptance of a step, by two comparisons of quantities that are known at both of its ends.
 *
 * First, the displacement must agree with the velocities. It does not after a correction that has led to another assembly branch: p has
 * then moved in a direction other than that of the velocity at the start, and the velocity at the end points elsewhere again. A step is
 * accepted if, in characteristic scales,
 *
 *     |p1 - p0 - h (pdot0 + pdot1) / 2|^2  <=  ASTRAY^2 h^2 (|pdot0|^2 + |pdot1|^2) / 2.
 *
 * The left side is of order h^6 as long as steps resolve the motion. Methods of order one differ from this mean where velocities change
 * a lot, as they do near rest. So a step that fails is accepted all the same if p1 - p0 is as close to h times some weighted mean of the
 * two velocities.
 *
 * Second, the step must be short enough for the method to be stable. In an instability the fastest component of the motion outgrows all
 * others; then vdot1 - vdot0 = -omega^2 (p1 - p0) gives its angular frequency omega. This is checked in every eighth step, and in every
 * step once one was too long. The other checks made in these steps, with adaptive steps, too, are in safeguards.c.
 *
 * When a check finds all quantities far from their limits, the interval to the next is doubled, up to ZD_CHECK_SELDOM steps. The first
 * comparison, made in each step, ends such an interval: up to terms of higher order its left side is h^2 / 12 (vdot1 - vdot0), and so
 * (omega h)^2 / 12 of p1 - p0. After a step in which this is more than a small part, or which is faster than at any check, checks are
 * eight steps apart again.
 */
#include "safeguards.h"

#include <math.h>
#include <string.h>

#include "../constraints/rank.h"
#include "../linalg/small.h"
#include "../point/point.h"

static const double ASTRAY = 0.5;
static const double NEARBY = 1e-8;      /* in characteristic scales: smaller detours come from rounding and tolerances */
static const double RESOLVED = 2;       /* largest omega h that steps resolve: one period is pi steps */
static const double AT_REST = 1e-24;    /* in characteristic scales, squared: below, the difference of accelerations is rounding */

zd_guard zd_guard_create(zd_arena *arena, zd_motion *motion, const zd_settings *settings, double stability, const zd_last *last,
                       zd_crossing *crossing)
{
    const zd_system *system = &motion->system;
    const zd_constraint_target *target = &motion->target;
    int holds = !(motion->drifts_from & ZD_PHI) || target->positions;
    int own = (system->provides & ZD_A) != 0;
    double least = NEARBY + 4 * target->tolerance, astray = ASTRAY * fmax(1, target->every), resolved = stability > 0 ? stability : RESOLVED;
    return (zd_guard){
        .motion = motion,
        .last = last,
        .crossing = crossing,
        .checks_branch = system->mh && holds,
        .checks_stability = settings->steps == ZD_FIXED_STEPS,
        .astray = 0.5 * astray * astray,
        .nearby = least * least,
        .limit = resolved * resolved * resolved * resolved,
        .pause = ZD_CHECK_EVERY,
        .is_ample = 1,
        .pdot = own ? zd_arena_doubles(arena, system->nq) : last->v,
        .rate = own ? zd_arena_doubles(arena, system->nq) : motion->point ? motion->point->v : NULL,
        .vdot = zd_arena_doubles(arena, system->nv),
    };
}

/* Squared distance of p1 - p0 from h (1 - s) pdot0 + h s pdot1, the minimum over 0 <= s <= 1. */
static double min_detour(const zd_guard *guard, double h)
{
    const zd_point *point = guard->motion->point;
    const double *inverse_unit = point->inverse_unit_p;
    double rest = 0, along = 0, turn = 0;
    for (int i = 0; i < point->system->nq; i++) {
        double a = (point->p[i] - guard->last->p[i] - h * guard->pdot[i]) * inverse_unit[i];
        double b = h * (guard->rate[i] - guard->pdot[i]) * inverse_unit[i];
        rest += a * a, along += a * b, turn += b * b;
    }
    double s = turn > 0 ? fmin(1, fmax(0, along / turn)) : 0;
    return rest - 2 * s * along + s * s * turn;
}

/* True if row k of C, in characteristic scales, has rotated by more than about 60 degrees since the start of the step. */
static int is_turned(const zd_point *point, const double *C0, int k)
{
    zd_row_of_C at_end = zd_point_row(point, k), at_start = zd_row_in(point, C0, k);
    double turned = 0, before = 0, after = 0;
    for (int j = 0; j < at_end.count; j++) {
        const int i = zd_column(&at_end, j);
        double a = at_start.x[j] * point->inverse_unit[i], b = at_end.x[j] * point->unit[i];
        turned += (b - a) * (b - a), before += a * a, after += b * b;
    }
    return !(turned <= fmax(before, after));
}

/* True if any row of C has rotated by that much; evaluated in long steps only. */
static int is_unresolved(zd_guard *guard, int *status)
{
    zd_point *point = guard->motion->point;
    int unresolved = 0;
    *status = zd_point_need(point, ZD_C);
    if (!*status) *status = zd_crossing_need_rows(guard->crossing);
    for (int k = 0; !*status && k < point->system->mh; k++) unresolved |= is_turned(point, guard->crossing->memory->C, k);
    return unresolved;
}

ZD_INLINE double squared_difference(const int n, const double *a, const double *b, const double *inverse_unit)
{
    double sum = 0;
    for (int i = 0; i < n; i++) sum += ((a[i] - b[i]) * inverse_unit[i]) * ((a[i] - b[i]) * inverse_unit[i]);
    return sum;
}

/* Updates the largest kinetic energy. On the matrix path M is known already, from the acceleration. */
static int note_energy(zd_guard *guard)
{
    int status = zd_point_need(guard->motion->point, ZD_M);
    if (!status) guard->kinetic = fmax(guard->kinetic, zd_point_kinetic(guard->motion->point));
    return status;
}

static void estimate_omega(zd_guard *guard, double moved, double h)
{
    const zd_point *point = guard->motion->point;
    double changed = ZD_SIZED(squared_difference, point->system->nv, point->vdot, guard->vdot, point->inverse_unit);
    double power = h * h * h * h * changed;                 /* (omega h)^4 moved; a division would cost as much as all of this */
    guard->is_ample = power <= ZD_AMPLE_STABILITY * guard->limit * moved;
    if (!(moved > AT_REST)) {
        guard->streak = 0;
        return;
    }
    if (power > guard->largest_fourth * moved && power < INFINITY) guard->largest_fourth = power / moved;
    guard->streak = power > guard->limit * moved ? guard->streak + 1 : 0;
    if (guard->streak >= ZD_UNSTABLE_STREAK)
        guard->motion->statistics.too_long += guard->streak == ZD_UNSTABLE_STREAK ? ZD_UNSTABLE_STREAK : 1;
}

/* The next multiple of `every` after this step. */
static int64_t next_of(int64_t every, int64_t step)
{
    return (step / every + 1) * every;
}

ZD_INLINE int evaluate_end(zd_guard *guard, int64_t next_step)
{
    zd_motion *motion = guard->motion;
    zd_point *point = motion->point;
    int status = zd_point_need_times_A(point, 0);
    /* The next step needs this acceleration anyway. */
    if (!status && (guard->watches_step || next_step >= guard->next_check)) status = zd_motion_accelerate(motion);
    if (!status && point->terms.A) zd_point_rate(point, point->v, guard->rate);
    return status;
}

void zd_guard_watch_next(zd_guard *guard)
{
    const zd_point *point = guard->motion->point;
    zd_copy_few(point->system->nv, point->vdot, guard->vdot);
    guard->watches_step = 1;
}

ZD_INLINE void keep(zd_guard *guard, int64_t next_step)
{
    const zd_point *point = guard->motion->point;
    if (point->terms.A) zd_copy(point->system->nq, guard->rate, guard->pdot);
    guard->watches_step = 0;
    if (next_step >= guard->next_check) zd_guard_watch_next(guard);
    guard->has_begun = 1;
}

static void check_soon(zd_guard *guard, int64_t next_step)
{
    const int64_t soon = next_of(ZD_CHECK_EVERY, next_step);
    guard->pause = ZD_CHECK_EVERY;
    if (guard->next_check > soon) guard->next_check = soon;
}

/* The most that a coordinate has moved: of many, all together move far in any step. */
static double largest_move(const zd_guard *guard)
{
    const zd_point *point = guard->motion->point;
    double largest = 0;
    for (int i = 0; i < point->system->nq; i++)
        largest = fmax(largest, fabs(point->p[i] - guard->last->p[i]) * point->inverse_unit_p[i]);
    return largest;
}

int zd_guard_begin(zd_guard *guard, int64_t step)
{
    int status = evaluate_end(guard, step);
    if (!status) keep(guard, step);
    return status;
}

int zd_guard_compare(zd_guard *guard, double h, int64_t next_step, zd_detour *found)
{
    const zd_point *point = guard->motion->point;
    int status = evaluate_end(guard, next_step);
    if (status) return status;
    const zd_detour sum = *found = ZD_SIZED(zd_guard_find, point->system->nq, guard, guard->last->p, point->p, h, point->inverse_unit_p);
    if (!zd_guard_is_calm(guard, &sum)) check_soon(guard, next_step);
    const double allowed = zd_guard_allows(guard, h, &sum);
    if (!guard->checks_branch) return ZD_DONE;
    if (!(sum.detour <= allowed) && !(min_detour(guard, h) <= allowed)) return ZD_BRANCH;
    if (sum.moved <= ZD_LONG_PATH * ZD_LONG_PATH || (point->rank->is_large && largest_move(guard) <= ZD_LONG_PATH)) return ZD_DONE;
    int unresolved = is_unresolved(guard, &status);
    return status ? status : unresolved ? ZD_BRANCH : ZD_DONE;
}

int zd_guard_watch(zd_guard *guard, const zd_detour *found, double h)
{
    if (guard->checks_stability) estimate_omega(guard, found->moved, h);
    guard->fastest = fmax(guard->fastest, found->speed);
    guard->reach = ZD_LONG_PATH * ZD_LONG_PATH;
    if (guard->checks_stability) guard->reach = fmin(guard->reach, ZD_FASTER_SPEED * h * h * guard->fastest + guard->nearby);
    return zd_has_energy(&guard->motion->system) ? note_energy(guard) : ZD_DONE;
}

void zd_guard_pause(zd_guard *guard, int64_t step, int is_ample)
{
    if (!is_ample || !guard->is_ample) guard->pause = ZD_CHECK_EVERY;
    else if (guard->pause < ZD_CHECK_SELDOM && step % guard->pause == 0) guard->pause *= 2;
    guard->next_check = guard->streak ? step + 1 : step < ZD_CHECK_EVERY ? 2 * step : next_of(guard->pause, step);
}

void zd_guard_save(zd_guard *guard, int64_t next_step)
{
    keep(guard, next_step);
}

double zd_guard_speed(const zd_guard *guard)
{
    const double *pdot = guard->pdot, *inverse_unit = guard->motion->point->inverse_unit_p;
    double sum = 0;
    for (int i = 0; i < guard->motion->system.nq; i++) sum += (pdot[i] * inverse_unit[i]) * (pdot[i] * inverse_unit[i]);
    return sqrt(sum);
}

double zd_guard_omega_h(const zd_guard *guard)
{
    return sqrt(sqrt(guard->largest_fourth));
}
