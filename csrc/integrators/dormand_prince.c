/* The method of order five by J. R. Dormand and P. J. Prince, A family of embedded Runge-Kutta formulae, Journal of Computational
 * and Applied Mathematics 6 (1980) 19-26.
 */
#include "interpolation.h"

static const double a[] = {
    0,              0,               0,              0,            0,               0,
    1.0 / 5,        0,               0,              0,            0,               0,
    3.0 / 40,       9.0 / 40,        0,              0,            0,               0,
    44.0 / 45,      -56.0 / 15,      32.0 / 9,       0,            0,               0,
    19372.0 / 6561, -25360.0 / 2187, 64448.0 / 6561, -212.0 / 729, 0,               0,
    9017.0 / 3168,  -355.0 / 33,     46732.0 / 5247, 49.0 / 176,   -5103.0 / 18656, 0,
};
static const double b[] = {35.0 / 384, 0, 500.0 / 1113, 125.0 / 192, -2187.0 / 6784, 11.0 / 84};
static const double c[] = {0, 1.0 / 5, 3.0 / 10, 4.0 / 5, 8.0 / 9, 1};

static const double e[] = {-71.0 / 57600, 0, 71.0 / 16695, -71.0 / 1920, 17253.0 / 339200, -22.0 / 525, 1.0 / 40};

/* Polynomial of order four for dense output: E. Hairer, S. P. Norsett, G. Wanner, Solving Ordinary Differential Equations I, 2nd edition,
 * 1993, section II.6 */
static const double d[] = {
    -12715105075.0 / 11282082432, 0, 87487479700.0 / 32700410799, -10690763975.0 / 1880347072, 701980252875.0 / 199316789632,
    -1453857185.0 / 822651844, 69997945.0 / 29380423,
};

static const zd_tableau tableau = {.stages = 6, .a = a, .b = b, .c = c, .e = e, .coefficients = 4, .d = d};

ZD_RUNGE_KUTTA_STEP
ZD_RUNGE_KUTTA_ERROR
ZD_RUNGE_KUTTA_INTERPOLATION

const zd_integrator zd_dormand_prince = {
    .card = {
        .name = "dormand_prince",
        .summary = "The explicit Runge-Kutta method of Dormand and Prince with six stages, as in RK45.",
        .equations = "Dormand and Prince, 1980",
        .order = 5, .error_order = 4, .stability = 1.7,
        .description = "Order five with an error estimate of order four for adaptive steps: the method of SciPy's RK45 and of ode45. For "
                       "errors of 1e-3 to 1e-6. Its dense output has order four.",
        .reference = "J. R. Dormand, P. J. Prince, A family of embedded Runge-Kutta formulae, Journal of Computational and "
                     "Applied Mathematics 6 (1980) 19-26",
    },
    .decay = 3.307,
    ZD_RUNGE_KUTTA, .error = error, ZD_INTERPOLATED,
};
