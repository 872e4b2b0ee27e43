/* Parts of a step whose state the formulation converts to the point and back: on the matrix path, and on the closed-form path where a step
 * ends with more than the projection.
 */
#include "../linalg/norms.h"
#include "../point/quaternions.h"
#include "choose.h"

static int integrate(zd_stepper *self, double h)
{
    zd_stepper_remember(self, h);
    int status = zd_stepper_make(self, h);
    if (status) return status;
    return zd_is_finite(self->motion->rate.size, self->y) ? ZD_DONE : ZD_NOT_FINITE;
}

static int project(zd_stepper *self, double t1, int64_t step, int forced)
{
    zd_motion *motion = self->motion;
    const zd_formulation *formulation = motion->formulation;
    zd_stepper_begin_end(self, t1);
    /* If Phi drifts, the state begins with p; otherwise p has been normalised when it was computed. */
    if (formulation->drifts_from & ZD_PHI) zd_quaternions_normalise(&motion->system, self->y);
    int status = formulation->enter(motion->solver, motion->point, t1, self->y);
    return status ? status : zd_motion_project(motion, step, forced);
}

static int correct(zd_stepper *self, int64_t step, int forced)
{
    return zd_motion_correct_rest(self->motion, step, forced);
}

static int finish(zd_stepper *self, int within)
{
    zd_motion *motion = self->motion;
    const zd_formulation *formulation = motion->formulation;
    zd_point_follow(motion->point);
    int status = within && formulation->settle ? formulation->express(motion->solver, motion->point, self->y)
                                               : formulation->leave(motion->solver, motion->point, self->y);
    /* Dependent velocities are recomputed from the state to the last bit, so that the next step can start from quantities known here. */
    if (!status && formulation->settle) status = formulation->settle(motion->solver, motion->point);
    return status || zd_point_is_finite(motion->point) ? status : ZD_NOT_FINITE;
}

static int check_by_matrices(zd_stepper *self, zd_safeguards *safeguards, int64_t next_step, int parts)
{
    return zd_safeguards_judge(safeguards, zd_safeguards_compare, self->t - self->last.t, next_step, parts);
}

int zd_path_check_pivots(zd_stepper *self, zd_safeguards *safeguards, int64_t next_step, int parts)
{
    return zd_safeguards_judge(safeguards, zd_direct_compare, self->t - self->last.t, next_step, parts);
}

const zd_evaluation_path zd_matrix_path = {"matrices", integrate, project, correct, finish, check_by_matrices};
const zd_evaluation_path zd_converted_path = {"closed form, state converted", integrate, project, correct, finish, zd_path_check_pivots};
