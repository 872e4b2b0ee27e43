/* Projection in closed form at the end of a step. Positions are iterated onto the constraints,
 *
 *     p <- p - dp     (25a), (26a), (27a)     until every |Phi| is at most its tolerance
 *
 * and the call of finish() that finds them converged also projects the velocities, (25b), (26b), (27b), and computes the acceleration for
 * the first stage of the next step. Sines and pivots are so computed once for all three.
 * One call of correct(), for other states and corrections, has those of positions and of velocities, the latter being of use after the last
 * iteration.
 */
#include "../linalg/small.h"
#include "../point/point.h"
#include "path.h"

ZD_INLINE int call_finish(const zd_iterate *it)
{
    const zd_motion *motion = it->motion;
    const zd_point *point = motion->point;
    const zd_path *path = &motion->path;
    return zd_path_order(motion)->finish(motion->system.data, point->terms.inputs, it->t, it->p, it->v, path->allowed, point->terms.Phi,
                                         path->dp, path->pdot, point->vdot, point->lambda, NULL, path->pivots);
}

int zd_project_and_accelerate(zd_motion *motion, double t, double *p, double *v)
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
    const int status = zd_path_order(motion)->correct(motion->system.data, point->terms.inputs, it->t, it->p, it->v, point->terms.Phi,
                                                      path->dp, path->dv);
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
    if (motion->path.finishes) return zd_project_and_accelerate(motion, point->t, point->p, point->v);
    const int status = correct(motion, positions, velocities);
    /* The next correction needs the dependent velocities at these positions. */
    return !status && motion->path.embeds && motion->corrections > 1 ? zd_embed_update(motion) : status;
}

int zd_project_converted(zd_stepper *self, double t1, int64_t step, int forced)
{
    int status = zd_path_unpack(self, t1);
    return status ? status : project_point(self->motion, step, forced);
}
