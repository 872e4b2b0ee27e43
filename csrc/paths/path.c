#include "path.h"

int zd_path_end(zd_stepper *self, double t, int within)
{
    const zd_evaluation_path *path = zd_path_of(self->motion);
    int status = path->project(self, t, 0, 1);
    if (!status && self->motion->others_after_step) status = path->correct(self, 0, 1);
    return status ? status : path->finish(self, within);
}
