/* Parts of a step in independent velocities on the closed-form path: embed() computes the dependent ones. */
#include "path.h"

static int integrate(zd_stepper *self, double h)
{
    return zd_matrix_path.integrate(self, h);
}

static int project(zd_stepper *self, double t1, int64_t step, int forced)
{
    zd_stepper_begin_end(self, t1);
    int status = zd_embed_enter(self->motion, t1, self->y);
    return status ? status : zd_motion_project(self->motion, step, forced);
}

static int correct(zd_stepper *self, int64_t step, int forced)
{
    return zd_motion_correct_rest(self->motion, step, forced);
}

static int finish(zd_stepper *self, int within)
{
    (void)within;       /* variables do not change within a step */
    int status = zd_embed_leave(self->motion, self->y);
    return status || zd_point_is_finite(self->motion->point) ? status : ZD_NOT_FINITE;
}

const zd_evaluation_path zd_independent_path = {
    "independent velocities, closed form", integrate, project, correct, finish, zd_path_check_pivots};
