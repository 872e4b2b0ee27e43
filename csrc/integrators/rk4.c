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

static const zd_tableau tableau = {.stages = 4, .a = a, .b = b, .c = c};

ZD_RUNGE_KUTTA_STEP

const zd_integrator zd_rk4 = {
    .card = {
        .name = "rk4",
        .summary = "The classical explicit Runge-Kutta method.",
        .equations = "section 4",
        .order = 4, .stability = 2.785,
        .description = "Four evaluations for each step, order four: the method of the paper's examples, and the "
                       "default. Its steps are fixed.",
        .reference = "W. Kutta, Beitrag zur naeherungsweisen Integration totaler Differentialgleichungen, Zeitschrift fuer "
                     "Mathematik und Physik 46 (1901) 435-453",
    },
    ZD_RUNGE_KUTTA,
};
