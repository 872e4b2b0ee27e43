/* Corrections after a step. */
#include "motion.h"

#include <math.h>

#include "../linalg/small.h"
#include "../point/quaternions.h"

enum which { ALL, PROJECTION, REST };

ZD_INLINE int correct(zd_motion *motion, int64_t step, int forced, const enum which which)
{
    for (int i = 0; i < motion->corrections; i++) {
        const zd_active *active = &motion->active[i];
        if (!active->row->after_step || !(forced || zd_is_one_of(active->every, step))) continue;
        if (which != ALL && (active->row->target != NULL) != (which == PROJECTION)) continue;
        int (*in_closed_form)(void *, zd_motion *) = active->row->in_closed_form;
        int status = in_closed_form && zd_is_direct(motion) ? in_closed_form(active->self, motion)
                                                            : active->row->after_step(active->self, motion);
        if (status) return status;
    }
    return ZD_DONE;
}

int zd_motion_correct(zd_motion *motion, int64_t step, int forced)
{
    return correct(motion, step, forced, ALL);
}

int zd_motion_project(zd_motion *motion, int64_t step, int forced)
{
    return correct(motion, step, forced, PROJECTION);
}

int zd_motion_correct_rest(zd_motion *motion, int64_t step, int forced)
{
    return correct(motion, step, forced, REST);
}

int zd_motion_is_corrected(const zd_motion *motion, int64_t step)
{
    for (int i = 0; i < motion->corrections; i++)
        if (motion->active[i].row->after_step && !zd_is_one_of(motion->active[i].every, step)) return 0;
    return 1;
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
    zd_quaternions_normalise(point->system, p);
    return ZD_DONE;
}

int zd_direct_land(zd_motion *motion, double t, double *p, double *v)
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
