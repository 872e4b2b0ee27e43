/* Parts of a step by matrices. */
#include "path.h"

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

const zd_evaluation_path zd_matrix_path = {"matrices", zd_path_integrate, project, correct, zd_path_finish, check};
