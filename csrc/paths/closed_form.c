/* Steps on the closed-form path that end with the projection and, optionally, the energy correction; equations of motion in closed form. */
#include "path.h"

#include <math.h>
#include <string.h>

#include "../constraints/rank.h"
#include "../linalg/small.h"
#include "../point/point.h"
#include "choose.h"

/* ---- equations of motion ---- */

/* With multipliers, power and pivots: at the end of a step, the first stage of the next. */
static int evaluate(zd_motion *motion, const double *added)
{
    zd_point *point = motion->point;
    zd_path *path = &motion->path;
    motion->statistics.evaluations++;
    return path->order->accelerate(motion->system.data, point->terms.inputs, &point->t, point->p, point->v, added, path->pdot, point->vdot,
                                   point->lambda, motion->balance.input ? &path->power : NULL, path->pivots);
}

int zd_closed_form_accelerate(zd_motion *motion, int (*evaluate_with)(zd_motion *motion, const double *added))
{
    zd_point *point = motion->point;
    int status = zd_point_need(point, motion->corrections_need);
    if (status) return status;
    if (motion->is_stabilized) {
        for (int k = 0; k < zd_constraints(point->system); k++) point->rhs[k] = 0;
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
    zd_copy_all(nq, point->terms.A ? motion->path.pdot : point->v, ydot);
    zd_copy_all(nv, point->vdot, ydot + nq);
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
    const size_t of_p = (size_t)nq * sizeof *y, of_v = (size_t)nv * sizeof *y;
    motion->state = y;
    int is_known = (point->known & ZD_ACCELERATED) && t == point->t && !memcmp(y, point->p, of_p) && !memcmp(y + nq, point->v, of_v);
    if (is_known || motion->is_stabilized) return rate_of_point(motion, t, y, ydot);
    motion->statistics.evaluations++;
    if (!point->terms.A) zd_copy_all(nv, y + nq, ydot);
    double *power = motion->balance.input ? ydot + motion->rate.size - 1 : NULL;
    int status = motion->path.order->accelerate(point->system->data, point->terms.inputs, &t, y, y + nq, NULL, ydot, ydot + nq, NULL, power,
                                                NULL);
    return status ? ZD_CALLBACK : ZD_DONE;
}

const zd_equations zd_equations_in_closed_form = {accelerate, rate, zd_motion_pack, NULL, NULL, 0, 0};

/* ---- integration ---- */

/* Zero times what is not finite is not a number; the sum has no branches. */
ZD_INLINE int is_finite(const int n, const double *y)
{
    double zero = 0;
    for (int i = 0; i < 2 * n; i++) zero += 0 * y[i];
    return zero == 0;
}

ZD_INLINE void save_start(const int n, zd_stepper *stepper)
{
    zd_copy(n, stepper->y, stepper->last.y);
    zd_copy(n, stepper->y + n, stepper->last.y + n);
}

ZD_INLINE int integrate(const int n, zd_stepper *stepper, double h)
{
    zd_motion *motion = stepper->motion;
    save_start(n, stepper);
    motion->rate.vdot = motion->point->known & ZD_ACCELERATED ? motion->point->vdot : NULL;
    int status = stepper->integrator->step(stepper->memory, &motion->rate, stepper->t, h, stepper->y, &motion->statistics);
    motion->rate.vdot = NULL;
    return status;      /* values that are not finite are found at the end of the step */
}

static int integrate_from(zd_stepper *stepper, double h)
{
    const zd_point *point = stepper->motion->point;
    stepper->last.t = stepper->t;
    stepper->last.h = h;
    point->rank->was_ill_conditioned = 0;
    return ZD_SIZED(integrate, point->system->nv, stepper, h);
}

/* ---- projection at the end of a step on the closed-form path ----
 *
 * Positions are iterated onto the constraints,
 *
 *     p <- p - dp     (25a), (26a), (27a)     until every |Phi| is at most its tolerance
 *
 * and the call that finds them converged also projects the velocities, (25b), (26b), (27b), and computes the acceleration for the first
 * stage of the next step. Sines and pivots are so computed once for all three.
 */

/* One iteration p <- p - dp; ZD_NO_CONVERGENCE or ZD_NOT_FINITE if none may follow. */
static int improve(zd_motion *motion, int iteration, double *first, double *p)
{
    zd_point *point = motion->point;
    const double residual = point->residual_left =
        ZD_SIZED(zd_largest_scaled, point->system->mh, point->terms.Phi, point->inverse_size);
    if (!isfinite(residual)) return ZD_NOT_FINITE;
    if (iteration == motion->target.max_iterations) return ZD_NO_CONVERGENCE;
    if (iteration == 0) *first = residual;
    if (iteration == 1 && !(residual <= ZD_TRUSTED_SHARE * *first)) return ZD_NO_CONVERGENCE;
    ZD_SIZED(zd_subtract_pairs, point->system->nq, p, motion->path.dp, p);    /* (25a), (26a), (27a) */
    if (point->system->quaternions) zd_quaternions_normalise(point->system, p);
    return ZD_DONE;
}

int zd_closed_form_finish(zd_motion *motion, double t, double *p, double *v)
{
    zd_point *point = motion->point;
    zd_path *path = &motion->path;
    const zd_system *system = &motion->system;
    double first = 0;
    int iterations = 0, status;
    for (;; iterations++) {
        status = path->order->finish(system->data, point->terms.inputs, &t, p, v, path->allowed, point->terms.Phi, path->dp, path->pdot,
                                   point->vdot, point->lambda, NULL, path->pivots);
        if (status != ZD_NO_CONVERGENCE) break;
        status = improve(motion, iterations, &first, p);
        if (status) break;
    }
    motion->statistics.evaluations += iterations + 1;
    zd_count_position_iterations(motion, iterations);
    point->known = status ? 0 : ZD_ACCELERATED;
    if (status) return status == ZD_NOT_FINITE || status == ZD_NO_CONVERGENCE ? status : ZD_CALLBACK;
    motion->statistics.velocity_corrections++;
    return ZD_DONE;
}

/* Projects the state y at t, and moves the point to it. */
ZD_INLINE int project(const int n, zd_stepper *stepper, double t, double *y)
{
    zd_point *point = stepper->motion->point;
    point->t = stepper->t = t;
    int status = zd_closed_form_finish(stepper->motion, t, y, y + n);
    zd_copy_pairs(n, y, point->p);
    zd_copy_pairs(n, y + n, point->v);
    return status;
}

static int project_state(zd_stepper *stepper, double t1, int64_t step, int forced)
{
    (void)step, (void)forced;       /* due in every step */
    return ZD_SIZED(project, stepper->motion->system.nv, stepper, t1, stepper->y);
}

/* Applies the other corrections at the point, and computes its acceleration. */
ZD_INLINE int correct(const int n, zd_stepper *stepper, double *y, int64_t step, int forced)
{
    zd_motion *motion = stepper->motion;
    int status = zd_motion_correct_rest(motion, step, forced);
    if (status) return status;
    zd_copy_pairs(n, motion->point->v, y + n);
    return zd_motion_accelerate(motion);
}

static int correct_state(zd_stepper *stepper, int64_t step, int forced)
{
    return ZD_SIZED(correct, stepper->motion->system.nv, stepper, stepper->y, step, forced);
}

/* ---- quick check of a step ----
 *
 * It passes nearly all steps, and only those that the full checks of guard.c and choose.c would pass without saving anything. Executed in
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

/* True if the step to (p, v) passes, with n coordinates and pdot = v. NaN and infinity fail each comparison. */
ZD_INLINE int passes_quick_check(const int n, zd_safeguards *self, double h, int64_t next_step, const double *p, const double *v)
{
    zd_guard *guard = &self->guard;
    const zd_last *last = guard->last;
    if (guard->watches_step) return 0;
    const seen_step seen = see(n, 0.5 * h, last->p, last->v, p, v, guard->motion->point->inverse_unit_p);
    if (!(ZD_CALM_DETOUR * ZD_CALM_DETOUR * seen.detour <= seen.moved + guard->nearby) || !(seen.moved <= guard->reach)) return 0;
    if (!pivots_stay(&guard->motion->path)) return 0;
    if (next_step >= guard->next_check) zd_guard_watch_next(guard);
    return 1;
}

ZD_RARE int check_fully(zd_stepper *stepper, zd_safeguards *safeguards, int64_t next_step, int parts)
{
    const int is_number = is_finite(stepper->motion->system.nv, stepper->y);
    return is_number ? zd_safeguards_judge(safeguards, zd_closed_form_compare, stepper->last.h, next_step, parts) : ZD_NOT_FINITE;
}

ZD_INLINE int check(const int n, zd_stepper *stepper, zd_safeguards *safeguards, int64_t next_step, int parts)
{
    const double *y = stepper->y;
    if (!parts && passes_quick_check(n, safeguards, stepper->last.h, next_step, y, y + n)) return ZD_DONE;
    return check_fully(stepper, safeguards, next_step, parts);
}

static int check_state(zd_stepper *stepper, zd_safeguards *safeguards, int64_t next_step, int parts)
{
    return ZD_SIZED(check, stepper->motion->system.nv, stepper, safeguards, next_step, parts);
}

const zd_evaluation_path zd_closed_form_path = {"closed form", 1, integrate_from, project_state, correct_state, NULL, check_state};

ZD_INLINE int project_within(const int n, zd_stepper *stepper, double t, double *y)
{
    int status = project(n, stepper, t, y);
    if (!status && stepper->motion->others_after_step) status = correct(n, stepper, y, 0, 1);
    return status || is_finite(n, y) ? status : ZD_NOT_FINITE;
}

int zd_plain_project_within(zd_stepper *stepper, double t, double *y)
{
    return ZD_SIZED(project_within, stepper->motion->system.nv, stepper, t, y);
}

/* Exchanges the arrays of accelerations at the end of the step with others: a copy would take as long as saving a sample. */
static void exchange_rates(zd_motion *motion, zd_cached_accelerations *rates)
{
    zd_exchange(&motion->point->vdot, &rates->vdot);
    zd_exchange(&motion->point->lambda, &rates->lambda);
    zd_exchange(&motion->path.pivots, &rates->pivots);
}

void zd_plain_save_rates(const zd_stepper *stepper, zd_cached_accelerations *rates)
{
    rates->smallest = stepper->motion->path.smallest;
    exchange_rates(stepper->motion, rates);
}

ZD_INLINE void return_to_end(const int n, const double *y, const zd_point *point)
{
    zd_copy_pairs(n, y, point->p);
    zd_copy_pairs(n, y + n, point->v);
}

void zd_plain_return_to_end(zd_stepper *stepper, double t, zd_cached_accelerations *rates)
{
    zd_motion *motion = stepper->motion;
    motion->point->t = stepper->t = t;
    motion->point->known = ZD_ACCELERATED;
    motion->path.smallest = rates->smallest;
    exchange_rates(motion, rates);
    ZD_SIZED(return_to_end, motion->system.nv, stepper->y, motion->point);
}
