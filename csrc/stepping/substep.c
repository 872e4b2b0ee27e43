/* A step to a time within the last one, repeated on the matrix path or in (p, v) where needed. */
#include <math.h>

#include "variables.h"

enum { MOST_HALVINGS = 8 };

static int integrate_and_finish(zd_stepper *self, double h, double t1)
{
    int status = zd_stepper_integrate(self, h);
    return status ? status : zd_stepper_land(self, t1, 0, 1);
}

static int attempt(zd_stepper *self, double t)
{
    double h = t - self->t;
    int status = integrate_and_finish(self, h, t);
    if (status && zd_is_direct(self->motion)) {
        zd_direct_leave(self->motion);
        status = zd_stepper_return(self);
        if (!status) status = integrate_and_finish(self, h, t);
    }
    if (zd_variables_lose_digits(self, status)) {
        status = zd_variables_use_dependent(self);
        if (!status) status = integrate_and_finish(self, h, t);
    }
    return status;
}

static int is_too_long(int status)
{
    return status == ZD_NO_STEP || status == ZD_NO_EMBEDDING || status == ZD_NO_CONVERGENCE;
}

/* Divided into parts if a single step fails: the run's own step may have converged only because its iteration started from the polynomial of
 * the step before, or was made in other variables. */
int zd_stepper_make_substep(zd_stepper *self, double t)
{
    double part = t - self->t;
    int status = attempt(self, t), halvings = 0;
    while (status ? is_too_long(status) && halvings < MOST_HALVINGS : self->t != t) {
        if (status) {
            halvings++;
            part /= 2;
            status = zd_stepper_return(self);
            if (status) break;
        }
        const double h = fmin(part, t - self->t);
        status = attempt(self, h == part ? self->t + h : t);
    }
    self->motion->statistics.output_steps++;
    return status;
}
