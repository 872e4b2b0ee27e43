/* Euler's explicit method, the cheapest and least accurate: for comparison. */
#include "runge_kutta.h"

static const double a[] = {
    0,
};
static const double b[] = {1};
static const double c[] = {0};

static const zd_tableau tableau = {1, a, b, c, NULL, NULL};

const zd_integrator zd_euler = {
    .card = {"euler", "Euler's explicit method: for comparison.", "Euler, 1768", 1, 0, 2},
    .decay = 2,
    ZD_RUNGE_KUTTA(tableau),
};
