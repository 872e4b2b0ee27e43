/* The explicit midpoint rule. */
#include "runge_kutta.h"

static const double a[] = {
    0,   0,
    0.5, 0,
};
static const double b[] = {0, 1};
static const double c[] = {0, 0.5};

static const zd_tableau tableau = {.stages = 2, .a = a, .b = b, .c = c};

ZD_RUNGE_KUTTA_STEP

const zd_integrator zd_midpoint = {
    .card = {
        .name = "midpoint",
        .summary = "The explicit midpoint rule.",
        .equations = "Runge, 1895",
        .order = 2, .stability = 2,
        .description = "Half a step by Euler's method gives the rate of the whole step: two evaluations for each step, order two.",
        .reference = "C. Runge, Ueber die numerische Aufloesung von Differentialgleichungen, Mathematische Annalen 46 (1895) "
                     "167-178",
    },
    ZD_RUNGE_KUTTA,
};
