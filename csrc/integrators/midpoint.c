/* The explicit midpoint rule. */
#include "runge_kutta.h"

static const double a[] = {
    0,   0,
    0.5, 0,
};
static const double b[] = {0, 1};
static const double c[] = {0, 0.5};

static const zd_tableau tableau = {2, a, b, c, NULL, NULL};

const zd_integrator zd_midpoint = {
    .card = {"midpoint", "The explicit midpoint rule.", "Runge, 1895", 2, 0, 2},
    .decay = 2,
    ZD_RUNGE_KUTTA(tableau),
};
