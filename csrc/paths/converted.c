/* Parts of a step in closed form whose state the formulation converts, as by matrices, and its projection: one call of correct() has the
 * corrections of positions and of velocities, the latter being of use after the last.
 */
#include "../linalg/iteration.h"
#include "../linalg/small.h"
#include "../point/point.h"
#include "path.h"

static int residual(void *context, double *size)
{
    zd_motion *motion = context;
    zd_point *point = motion->point;
    zd_path *path = &motion->path;
    motion->statistics.evaluations++;
    int status = path->order->correct(motion->system.data, point->terms.inputs, &point->t, point->p, point->v, point->terms.Phi, path->dp,
                                      path->dv);
    if (status) return ZD_CALLBACK;
    *size = zd_point_violation(point);
    return ZD_DONE;
}

static int improve(void *context)
{
    const zd_motion *motion = context;
    const zd_path *path = &motion->path;
    ZD_SIZED(zd_subtract, motion->system.nq, motion->point->p, path->dp, path->corrected);      /* (25a), (26a), (27a) */
    zd_quaternions_normalise(&motion->system, path->corrected);
    zd_point_move_position(motion->point, path->corrected);
    return ZD_DONE;
}

static int iterate(zd_motion *motion)
{
    const zd_newton newton = {residual, improve, motion->target.tolerance, motion->target.max_iterations, ZD_TRUSTED_SHARE, NULL, 0};
    int iterations, status = zd_newton_solve(&newton, motion, &iterations, &motion->point->residual_left);
    zd_count_position_iterations(motion, iterations);
    return status;
}

static int correct_both(zd_motion *motion, int positions, int velocities)
{
    zd_path *path = &motion->path;
    double size;
    int status = positions && motion->system.mh ? iterate(motion) : residual(motion, &size);
    if (status || !velocities) return status;
    ZD_SIZED(zd_subtract, motion->system.nv, motion->point->v, path->dv, path->corrected);   /* (25b), (26b), (27b) */
    zd_point_move_velocity(motion->point, path->corrected);
    motion->statistics.velocity_corrections++;
    return ZD_DONE;
}

int zd_project_in_closed_form(zd_motion *motion, int64_t step, int forced)
{
    const zd_constraint_target *target = &motion->target;
    const int positions = target->positions && (motion->drifts_from & motion->corrects & ZD_PHI);
    const int velocities = target->velocities && (motion->drifts_from & motion->corrects & ZD_C);
    zd_point *point = motion->point;
    if (!target->every || !(forced || zd_is_one_of(target->every, step))) return ZD_DONE;
    if (!target->in_mass_metric) return zd_motion_project(motion, step, forced);
    if (!zd_constraints(&motion->system) || !(positions || velocities)) return ZD_DONE;
    if (motion->path.finishes) return zd_closed_form_finish(motion, point->t, point->p, point->v);
    const int status = correct_both(motion, positions, velocities);
    /* The next correction needs the dependent velocities at these positions. */
    return !status && motion->path.embeds && motion->corrections > 1 ? zd_embed_update(motion) : status;
}

static int project(zd_stepper *self, double t1, int64_t step, int forced)
{
    int status = zd_path_unpack(self, t1);
    return status ? status : zd_project_in_closed_form(self->motion, step, forced);
}

const zd_evaluation_path zd_converted_path = {
    "closed form, state converted", 1, zd_path_integrate, project, zd_path_correct, zd_path_finish, zd_path_check_pivots};
