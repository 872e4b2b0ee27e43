/* Heun's method, the explicit counterpart of the trapezoidal rule. */
#include "runge_kutta.h"

static const double a[] = {
    0, 0,
    1, 0,
};
static const double b[] = {0.5, 0.5};
static const double c[] = {0, 1};

static const zd_tableau tableau = {2, a, b, c, NULL, NULL};

const zd_integrator zd_heun = {
    .card = {"heun", "Heun's method: the explicit trapezoidal rule.", "Heun, 1900", 2, 0, 2},
    .decay = 2,
    ZD_RUNGE_KUTTA(tableau),
};
