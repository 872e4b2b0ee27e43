/* A shorter step, to a time between steps: in the variables that serve there. */
#include "short_step.h"
#include "variables.h"

static int integrate_and_land(zd_stepper *self, double h, double t1)
{
    int status = zd_stepper_integrate(self, h);
    return status ? status : zd_stepper_land(self, t1, 0, 1);
}

int zd_stepper_may_spread(const zd_stepper *self, double t0)
{
    /* Where v follows from the state, variables may be chosen anew at each place. */
    return self->integrator->spread && !self->motion->formulation->settle && self->last.t == t0 && self->last.h == self->t - t0;
}

int zd_stepper_spread(zd_stepper *self)
{
    zd_motion *motion = self->motion;
    const zd_last *last = &self->last;
    /* The point is where the step has ended. */
    motion->rate.vdot = zd_is_short(motion) && motion->point->known & ZD_ACCELERATED ? motion->point->vdot : NULL;
    int status = self->integrator->spread(self->memory, &motion->rate, last->t, last->h, last->y, self->y);
    motion->rate.vdot = NULL;
    return status;
}

int zd_stepper_land_between(zd_stepper *self, double t, double *y)
{
    const zd_last *last = &self->last;
    self->integrator->between(self->memory, (t - last->t) / last->h, last->y, y);
    self->motion->statistics.output_steps++;
    return zd_is_short(self->motion) ? zd_short_land_between(self, t, y) : zd_stepper_land(self, t, 0, 1);
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
