/* The closed-form path: equations of motion, projection, parts of a step, and its quick check. */
#include "path.h"

#include <string.h>

#include "../constraints/rank.h"
#include "../linalg/small.h"
#include "../point/point.h"

/* ---- equations of motion ---- */

/* With multipliers, power and pivots: at the end of a step, the first stage of the next. */
static int evaluate(zd_motion *motion, const double *added)
{
    zd_point *point = motion->point;
    zd_path *path = &motion->path;
    motion->statistics.evaluations++;
    const zd_elimination *order = zd_path_order(motion);
    return order->accelerate(order, motion->system.data, point->terms.inputs, &point->t, point->p, point->v, added, path->pdot, point->vdot,
                             point->lambda, motion->balance.input ? &path->power : NULL, path->pivots);
}

int zd_closed_form_accelerate(zd_motion *motion, int (*evaluate_with)(zd_motion *motion, const double *added))
{
    zd_point *point = motion->point;
    int status = zd_point_need(point, motion->corrections_need);
    if (status) return status;
    if (motion->is_stabilized) {
        zd_clear(zd_constraints(point->system), point->rhs);
        zd_motion_stabilize(motion);
    }
    if (evaluate_with(motion, motion->is_stabilized ? point->rhs : NULL)) return ZD_CALLBACK;
    point->known |= ZD_ACCELERATED;
    motion->path.smallest = 0;
    return ZD_DONE;
}

static int accelerate(zd_motion *motion)
{
    return zd_closed_form_accelerate(motion, evaluate);
}

/* Rate of the state y after the point has been moved to it. */
static int rate_of_point(zd_motion *motion, double t, const double *y, double *ydot)
{
    zd_point *point = motion->point;
    const int nq = point->system->nq, nv = point->system->nv;
    zd_point_move(point, t, y, y + nq);
    if (motion->corrections_size) point->known &= ~ZD_ACCELERATED;
    int status = zd_motion_accelerate(motion);
    if (status) return status;
    zd_copy_few(nq, point->terms.A ? motion->path.pdot : point->v, ydot);
    zd_copy_few(nv, point->vdot, ydot + nq);
    if (motion->corrections_size) zd_motion_extra_rates(motion, ydot);
    if (motion->balance.input) ydot[motion->rate.size - 1] = motion->path.power;
    return ZD_DONE;
}

/* Stages of a step do not move the point: it stays at the start of the step, whose acceleration is that of the first stage. */
static int rate(void *context, double t, const double *y, double *ydot)
{
    zd_motion *motion = context;
    const zd_point *point = motion->point;
    const int nq = point->system->nq, nv = point->system->nv;
    const size_t of_p = nq * sizeof *y, of_v = nv * sizeof *y;
    int is_known = (point->known & ZD_ACCELERATED) && t == point->t && !memcmp(y, point->p, of_p) && !memcmp(y + nq, point->v, of_v);
    if (motion->is_stabilized) motion->state = y;
    if (is_known || motion->is_stabilized) return rate_of_point(motion, t, y, ydot);
    motion->statistics.evaluations++;
    if (!point->terms.A) zd_copy_few(nv, y + nq, ydot);
    double *power = motion->balance.input ? ydot + motion->rate.size - 1 : NULL;
    const zd_elimination *order = zd_path_order(motion);
    int status = order->accelerate(order, point->system->data, point->terms.inputs, &t, y, y + nq, NULL, ydot, ydot + nq, NULL, power, NULL);
    return status ? ZD_CALLBACK : ZD_DONE;
}

const zd_equations zd_equations_in_closed_form = {
    accelerate, rate, zd_motion_unpack, zd_motion_pack, zd_motion_finish, NULL, NULL, 0, 0};

/* ---- projection at the end of a step ----
 *
 * Positions are iterated onto the constraints,
 *
 *     p <- p - dp     (25a), (26a), (27a)     until every |Phi| is at most its tolerance
 *
 * and the call of finish() that finds them converged also projects the velocities, (25b), (26b), (27b), and computes the acceleration for
 * the first stage of the next step. Sines and pivots are so computed once for all three.
 * One call of correct(), for other states and corrections, has those of positions and of velocities, the latter being of use after the last
 * iteration.
 */

ZD_INLINE int call_finish(const zd_iterate *it)
{
    const zd_motion *motion = it->motion;
    const zd_point *point = motion->point;
    const zd_path *path = &motion->path;
    const zd_elimination *order = zd_path_order(motion);
    return order->finish(order, motion->system.data, point->terms.inputs, it->t, it->p, it->v, path->allowed, point->terms.Phi, path->dp,
                         path->pdot, point->vdot, point->lambda, NULL, path->pivots);
}

/* Projects p and v at t, and computes the point's acceleration there. p and v are the point's own, or the caller copies them there. */
static int project_and_accelerate(zd_motion *motion, double t, double *p, double *v)
{
    zd_point *point = motion->point;
    const zd_iterate it = {motion, &t, p, v};
    int iterations;
    const int status = zd_iterate_in_closed_form(&it, call_finish, motion->target.max_iterations, point->terms.Phi, &iterations,
                                                 &point->residual_left);
    zd_count_position_iterations(motion, iterations);
    point->known = status ? 0 : ZD_ACCELERATED;
    motion->statistics.velocity_corrections += !status;
    return status;
}

static int call_correct(const zd_iterate *it)
{
    const zd_motion *motion = it->motion;
    const zd_point *point = motion->point;
    const zd_path *path = &motion->path;
    const zd_elimination *order = zd_path_order(motion);
    const int status = order->correct(order, motion->system.data, point->terms.inputs, it->t, it->p, it->v, point->terms.Phi, path->dp,
                                      path->dv);
    return status || zd_point_violation(point) <= motion->target.tolerance ? status : ZD_NO_CONVERGENCE;
}

static int correct(zd_motion *motion, int positions, int velocities)
{
    zd_point *point = motion->point;
    const zd_iterate it = {motion, &point->t, point->p, point->v};
    const int max_iterations = positions && motion->system.mh ? motion->target.max_iterations : 0;
    int iterations, status = zd_iterate_in_closed_form(&it, call_correct, max_iterations, point->terms.Phi, &iterations,
                                                       &point->residual_left);
    zd_count_position_iterations(motion, iterations);
    point->known &= point->constant;
    if (status == ZD_NO_CONVERGENCE && !max_iterations) status = ZD_DONE;       /* velocities are corrected alone */
    if (status || !velocities) return status;
    zd_correct_velocity(&motion->system, point->v, motion->path.dv, point->v);      /* (25b), (26b), (27b) */
    motion->statistics.velocity_corrections++;
    return ZD_DONE;
}

static int project_point(zd_motion *motion, int64_t step, int forced)
{
    const zd_constraint_target *target = &motion->target;
    const int positions = target->positions && (motion->drifts_from & motion->corrects & ZD_PHI);
    const int velocities = target->velocities && (motion->drifts_from & motion->corrects & ZD_C);
    zd_point *point = motion->point;
    if (!target->every || !(forced || zd_is_one_of(target->every, step))) return ZD_DONE;
    if (!target->in_mass_metric) return zd_motion_project(motion, step, forced);
    if (!zd_constraints(&motion->system) || !(positions || velocities)) return ZD_DONE;
    if (motion->path.finishes) return project_and_accelerate(motion, point->t, point->p, point->v);
    const int status = correct(motion, positions, velocities);
    /* The next correction needs the dependent velocities at these positions. */
    return !status && motion->path.embeds && motion->corrections > 1 ? zd_embed_update(motion) : status;
}

ZD_RARE int project_converted(zd_stepper *self, double t1, int64_t step, int forced)
{
    int status = zd_path_unpack(self, t1);
    return status ? status : project_point(self->motion, step, forced);
}

/* ---- parts of a step, of a plain state in place ---- */

/* True if 2 n numbers are finite: zero times others is NaN. The sum has no branches. */
ZD_INLINE int is_finite(const int n, const double *y)
{
    double zero = 0;
    for (int i = 0; i < 2 * n; i++) zero += 0 * y[i];
    return zero == 0;
}

ZD_INLINE int integrate_plain(const int n, zd_stepper *stepper, double h)
{
    zd_motion *motion = stepper->motion;
    stepper->last.t = stepper->t;
    stepper->last.h = h;
    motion->point->rank->was_ill_conditioned = 0;
    zd_copy(n, stepper->y, stepper->last.y);
    zd_copy(n, stepper->y + n, stepper->last.y + n);
    /* Values that are not finite are found at the end of the step. */
    return stepper->integrator->step(stepper->memory, &motion->rate, stepper->t, h, stepper->y, &motion->statistics);
}

static int integrate(zd_stepper *stepper, double h)
{
    const zd_motion *motion = stepper->motion;
    return motion->path.is_plain ? ZD_SIZED(integrate_plain, motion->system.nv, stepper, h) : zd_path_integrate(stepper, h);
}

ZD_INLINE void copy_to_point(const int n, const double *y, zd_point *point)
{
    zd_copy_pairs(n, y, point->p);
    zd_copy_pairs(n, y + n, point->v);
}

ZD_INLINE int project_plain(zd_stepper *stepper, double t, double *y)
{
    zd_point *point = stepper->motion->point;
    point->t = stepper->t = t;
    int status = project_and_accelerate(stepper->motion, t, y, y + point->system->nv);
    ZD_SIZED(copy_to_point, point->system->nv, y, point);
    return status;
}

static int project(zd_stepper *stepper, double t1, int64_t step, int forced)
{
    const int is_plain = stepper->motion->path.is_plain;
    return is_plain ? project_plain(stepper, t1, stepper->y) : project_converted(stepper, t1, step, forced);
}

static int correct_rest(zd_stepper *stepper, int64_t step, int forced)
{
    zd_motion *motion = stepper->motion;
    int status = zd_motion_correct_rest(motion, step, forced);
    if (status || !motion->path.is_plain) return status;
    zd_copy_few(motion->system.nv, motion->point->v, stepper->y + motion->system.nv);
    return zd_motion_accelerate(motion);
}

static int finish(zd_stepper *stepper, int within)
{
    zd_motion *motion = stepper->motion;
    if (!motion->path.is_plain) return zd_path_finish(stepper, within);
    return ZD_SIZED(is_finite, motion->system.nv, stepper->y) ? ZD_DONE : ZD_NOT_FINITE;
}

/* ---- quick check of a step ----
 *
 * It passes nearly all steps, and only those that the full checks of guard.c and path.c would pass without saving anything. Executed in
 * every step, it takes fewer instructions by sufficient conditions: if the detour is at most 1 / ZD_CALM_DETOUR of the displacement, it
 * satisfies the bound by the velocities at both ends, too; and pivots of one sign within a factor of four of one number have neither changed
 * sign nor shrunk by more than 16.
 */

/* Displacement and detour (p1 - p0 - h (v0 + v1) / 2) of a step: sums of squares in characteristic scales. Below, `half` is h / 2. */
typedef struct seen_step {
    double moved, detour;
} seen_step;

ZD_INLINE void see_one(seen_step *seen, int i, double half, const double *p0, const double *v0, const double *p, const double *v,
                       const double *inverse_unit)
{
    const double path = p[i] - p0[i], missed = path - half * (v0[i] + v[i]);
    seen->moved += (path * inverse_unit[i]) * (path * inverse_unit[i]);
    seen->detour += (missed * inverse_unit[i]) * (missed * inverse_unit[i]);
}

/* Sums over n coordinates with pdot = v, from (p0, v0) to (p, v), two at a time in vectors. */
ZD_INLINE seen_step see(const int n, double half, const double *p0, const double *v0, const double *p, const double *v,
                        const double *inverse_unit)
{
    seen_step seen = {0, 0};
#ifdef ZD_HAS_VECTORS
#define ZD_TWO(x) (*(const zd_stored_two *)((x) + i))
    const zd_two halves = {half, half};
    zd_two moved = {0, 0}, detour = {0, 0};
    for (int i = 0; i + 1 < n; i += 2) {
        const zd_two path = ZD_TWO(p) - ZD_TWO(p0), missed = path - halves * (ZD_TWO(v0) + ZD_TWO(v));
        const zd_two a = path * ZD_TWO(inverse_unit), b = missed * ZD_TWO(inverse_unit);
        moved = i ? moved + a * a : a * a;
        detour = i ? detour + b * b : b * b;
    }
#undef ZD_TWO
    if (n > 1) seen = (seen_step){moved[0] + moved[1], detour[0] + detour[1]};
    if (n % 2) see_one(&seen, n - 1, half, p0, v0, p, v, inverse_unit);
#else
    for (int i = 0; i < n; i++) see_one(&seen, i, half, p0, v0, p, v, inverse_unit);
#endif
    return seen;
}

/* True if all pivots are within their ranges; the next step then uses the same elimination order, the first. Bits are compared as integers,
 * which are ordered as the magnitudes are, because the floating-point units are busy with the next step. */
ZD_INLINE int pivots_stay(zd_path *path)
{
    for (int k = 0; k < path->ranges; k++) {
        uint64_t bits;
        memcpy(&bits, path->pivots + k, sizeof bits);
        if (bits - path->range[k].least > path->range[k].width) return 0;
    }
    path->was_taken = path->continues = 1;
    return 1;
}

/* True if the step passes, of a plain state with n coordinates. NaN and infinity fail each comparison. */
ZD_INLINE int passes_quick_check(const int n, const zd_stepper *stepper, zd_safeguards *self, int64_t next_step)
{
    const double *y = stepper->y;
    zd_guard *guard = &self->guard;
    const zd_last *last = guard->last;
    if (guard->watches_step) return 0;
    const seen_step seen = see(n, 0.5 * last->h, last->p, last->v, y, y + n, guard->motion->point->inverse_unit_p);
    if (!(ZD_CALM_DETOUR * ZD_CALM_DETOUR * seen.detour <= seen.moved + guard->nearby) || !(seen.moved <= guard->reach)) return 0;
    if (!pivots_stay(&guard->motion->path)) return 0;
    if (next_step >= guard->next_check) zd_guard_watch_next(guard);
    return 1;
}

ZD_RARE int check_fully(zd_stepper *stepper, zd_safeguards *safeguards, int64_t next_step, int parts)
{
    const double h = stepper->motion->path.is_plain ? stepper->last.h : stepper->t - stepper->last.t;
    int status = finish(stepper, 0);
    return status ? status : zd_safeguards_judge(safeguards, zd_closed_form_compare, h, next_step, parts);
}

static int check(zd_stepper *stepper, zd_safeguards *safeguards, int64_t next_step, int parts)
{
    const int may_be_quick = stepper->motion->path.is_plain && !parts;
    return may_be_quick && ZD_SIZED(passes_quick_check, stepper->motion->system.nv, stepper, safeguards, next_step) ? ZD_DONE
         : check_fully(stepper, safeguards, next_step, parts);
}

const zd_evaluation_path zd_closed_form_path = {integrate, project, correct_rest, finish, check};
