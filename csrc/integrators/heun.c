/* Heun's method, the explicit counterpart of the trapezoidal rule. */
#include "runge_kutta.h"

static const double a[] = {
    0, 0,
    1, 0,
};
static const double b[] = {0.5, 0.5};
static const double c[] = {0, 1};

static const zd_tableau tableau = {.stages = 2, .a = a, .b = b, .c = c};

ZD_RUNGE_KUTTA_STEP

const zd_integrator zd_heun = {
    .card = {
        .name = "heun",
        .summary = "Heun's method: the explicit trapezoidal rule.",
        .equations = "Heun, 1900",
        .order = 2, .stability = 2,
        .description = "A step by Euler's method gives the rate at its end, and the step is repeated with the mean of both rates: two "
                       "evaluations for each step, order two.",
        .reference = "K. Heun, Neue Methoden zur approximativen Integration, Zeitschrift fuer Mathematik und Physik 45 (1900) "
                     "23-38",
    },
    ZD_RUNGE_KUTTA,
};
