/* User functions that are inputs. */
#include "elements.h"

void zd_effort_input(const double *numbers, double t, const double *x, const double *xdot, double *out)
{
    (void)t, (void)x, (void)xdot;
    out[0] = numbers[0];
}

/* The nonholonomic drive xdot - speed(t) = 0. */
void zd_speed_input(const double *numbers, double t, const double *x, const double *xdot, double *out)
{
    (void)x, (void)xdot;
    out[0] = 0;
    out[1] = 1;
    out[2] = -(numbers[0] + numbers[1] * (t - numbers[2]));
    out[3] = -numbers[1];
}
