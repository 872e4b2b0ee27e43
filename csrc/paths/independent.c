/* Parts of a step in independent velocities on the closed-form path: embed() computes the dependent ones. */
#include "path.h"

static int project(zd_stepper *self, double t1, int64_t step, int forced)
{
    zd_stepper_begin_end(self, t1);
    int status = zd_embed_unpack(self->motion, t1, self->y);
    return status ? status : zd_project_in_closed_form(self->motion, step, forced);
}

static int finish(zd_stepper *self, int within)
{
    (void)within;       /* variables do not change within a step */
    int status = zd_embed_pack(self->motion, self->y);
    return status || zd_point_is_finite(self->motion->point) ? status : ZD_NOT_FINITE;
}

const zd_evaluation_path zd_independent_path = {
    "independent velocities, closed form", 1, zd_path_integrate, project, zd_path_correct, finish, zd_path_check_pivots};
