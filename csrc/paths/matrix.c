/* Parts of a step by matrices: the formulation converts the state to the point and back. */
#include "../linalg/small.h"
#include "../point/point.h"
#include "path.h"

int zd_path_integrate(zd_stepper *self, double h)
{
    zd_stepper_save_start(self, h);
    int status = zd_stepper_make(self, h);
    if (status) return status;
    return zd_is_finite(self->motion->rate.size, self->y) ? ZD_DONE : ZD_NOT_FINITE;
}

int zd_path_unpack(zd_stepper *self, double t1)
{
    zd_motion *motion = self->motion;
    const zd_formulation *formulation = motion->formulation;
    zd_stepper_begin_end(self, t1);
    /* If Phi drifts, the state begins with p; otherwise p has been normalised when it was computed. */
    if (formulation->drifts_from & ZD_PHI) zd_quaternions_normalise(&motion->system, self->y);
    return formulation->unpack(motion->solver, motion->point, t1, self->y);
}

static int project(zd_stepper *self, double t1, int64_t step, int forced)
{
    int status = zd_path_unpack(self, t1);
    return status ? status : zd_motion_project(self->motion, step, forced);
}

int zd_path_correct(zd_stepper *self, int64_t step, int forced)
{
    return zd_motion_correct_rest(self->motion, step, forced);
}

int zd_path_finish(zd_stepper *self, int within)
{
    zd_motion *motion = self->motion;
    const zd_formulation *formulation = motion->formulation;
    zd_point_follow(motion->point);
    int status = within && formulation->update ? formulation->express(motion->solver, motion->point, self->y)
                                               : formulation->pack(motion->solver, motion->point, self->y);
    /* Dependent velocities are recomputed from the state to the last bit, so that the next step can start from quantities known here. */
    if (!status && formulation->update) status = formulation->update(motion->solver, motion->point);
    return status || zd_point_is_finite(motion->point) ? status : ZD_NOT_FINITE;
}

static int check(zd_stepper *self, zd_safeguards *safeguards, int64_t next_step, int parts)
{
    return zd_safeguards_judge(safeguards, zd_safeguards_compare, self->t - self->last.t, next_step, parts);
}

const zd_evaluation_path zd_matrix_path = {"matrices", 0, zd_path_integrate, project, zd_path_correct, zd_path_finish, check};
