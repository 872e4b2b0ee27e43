/* Euler's explicit method, the cheapest and least accurate: for comparison. */
#include "runge_kutta.h"

static const double a[] = {
    0,
};
static const double b[] = {1};
static const double c[] = {0};

static const zd_tableau tableau = {.stages = 1, .a = a, .b = b, .c = c};

ZD_RUNGE_KUTTA_STEP

const zd_integrator zd_euler = {
    .card = {
        .name = "euler",
        .summary = "Euler's explicit method, for comparison.",
        .equations = "Euler, 1768",
        .order = 1, .stability = 2,
        .description = "One evaluation for each step. Its error is proportional to the step, and it adds energy to oscillations; it is "
                       "provided for comparison.",
        .reference = "E. Hairer, S. P. Norsett, G. Wanner, Solving Ordinary Differential Equations I, 2nd edition, Springer, "
                     "1993, section I.7",
    },
    ZD_RUNGE_KUTTA,
};
