/* Parts of a step by matrices, and those of a state on either path that is converted to the point and back. */
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
    self->t = t1;
    motion->state = self->y;
    if (motion->corrections_size) motion->point->known &= ~ZD_ACCELERATED;
    return motion->equations->unpack(motion, t1, self->y);
}

int zd_path_finish(zd_stepper *self, int within)
{
    int status = self->motion->equations->finish(self->motion, self->y, within);
    return status || zd_point_is_finite(self->motion->point) ? status : ZD_NOT_FINITE;
}

static int project(zd_stepper *self, double t1, int64_t step, int forced)
{
    int status = zd_path_unpack(self, t1);
    return status ? status : zd_motion_project(self->motion, step, forced);
}

static int correct(zd_stepper *self, int64_t step, int forced)
{
    return zd_motion_correct_rest(self->motion, step, forced);
}

static int check(zd_stepper *self, zd_safeguards *safeguards, int64_t next_step, int parts)
{
    int status = zd_path_finish(self, 0);
    return status ? status : zd_safeguards_judge(safeguards, zd_safeguards_compare, self->t - self->last.t, next_step, parts);
}

const zd_evaluation_path zd_matrix_path = {zd_path_integrate, project, correct, zd_path_finish, check};
