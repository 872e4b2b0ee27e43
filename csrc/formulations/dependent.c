/* State (p, v) of the dependent formulations, and its rate: (1), and the acceleration. */
#include "formulation.h"

#include "../linalg/small.h"
#include "../point/point.h"

int zd_dependent_state_size(const zd_system *system)
{
    return system->nq + system->nv;
}

int zd_dependent_unpack(void *self, zd_point *point, double t, const double *y)
{
    (void)self;
    zd_point_move(point, t, y, y + point->system->nq);
    return ZD_DONE;
}

int zd_dependent_pack(void *self, zd_point *point, double *y)
{
    (void)self;
    zd_copy_few(point->system->nq, point->p, y);
    zd_copy_few(point->system->nv, point->v, y + point->system->nq);
    return ZD_DONE;
}

int zd_dependent_rate(void *self, zd_point *point, double *ydot)
{
    (void)self;
    int status = zd_point_need_times_A(point, 0);
    if (status) return status;
    zd_point_rate(point, point->v, ydot);                               /* (1) */
    zd_copy_few(point->system->nv, point->vdot, ydot + point->system->nq);
    return ZD_DONE;
}
