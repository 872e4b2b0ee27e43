/* Parts of a step on either path, of a state that is converted to the point and back. */
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
    zd_stepper_begin_end(self, t1);
    return self->motion->equations->unpack(self->motion, t1, self->y);
}

int zd_path_finish(zd_stepper *self, int within)
{
    int status = self->motion->equations->finish(self->motion, self->y, within);
    return status || zd_point_is_finite(self->motion->point) ? status : ZD_NOT_FINITE;
}
