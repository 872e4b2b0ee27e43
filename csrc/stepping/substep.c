/* A shorter step, to a time between steps: in the variables that serve there. */
#include "variables.h"

static int integrate_and_land(zd_stepper *self, double h, double t1)
{
    int status = zd_stepper_integrate(self, h);
    return status ? status : zd_stepper_land(self, t1, 0, 1);
}

int zd_stepper_make_substep(zd_stepper *self, double t)
{
    double h = t - self->t;
    int status = integrate_and_land(self, h, t);
    if (status && zd_is_direct(self->motion)) {
        zd_direct_leave(self->motion);
        status = zd_stepper_return(self);
        if (!status) status = integrate_and_land(self, h, t);
    }
    if (zd_variables_lose_digits(self, status)) {
        status = zd_variables_use_dependent(self);
        if (!status) status = integrate_and_land(self, h, t);
    }
    self->motion->statistics.output_steps++;
    return status;
}
