/* The classical Runge-Kutta method of order four, the paper's. */
#include "runge_kutta.h"

static const double a[] = {
    0,   0,   0, 0,
    0.5, 0,   0, 0,
    0,   0.5, 0, 0,
    0,   0,   1, 0,
};
static const double b[] = {1.0 / 6, 1.0 / 3, 1.0 / 3, 1.0 / 6};
static const double c[] = {0, 0.5, 0.5, 1};

static const zd_tableau tableau = {4, a, b, c, NULL, NULL};

const zd_integrator zd_rk4 = {
    .card = {"rk4", "The classical explicit Runge-Kutta method.", "section 4", 4, 0, 2.785},
    .decay = 2.785,
    ZD_RUNGE_KUTTA(tableau),
};
