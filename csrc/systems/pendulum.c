/* A point mass on a massless rod, in Cartesian coordinates: the smallest system that can drift from its constraint.
 *
 *     o--------> x        p = [x, y], the mass as seen from the pivot; gravity along -y
 *      \
 *       \ L               Phi = (x^2 + y^2 - L^2) / (2 L)
 *        \
 *         *  (x, y)       After A01 of the IFToMM library of multibody benchmark problems, and SUNDIALS' cvPendulum.
 *
 * Divided by 2 L, Phi is to first order the distance from the circle in m and C a unit vector: C M^-1 C^T = 1 / m at any length,
 * and lambda is the tension of the rod in N.
 */
#include <string.h>

#include "../include/zerodrift/sines.h"
#include "../include/zerodrift/system.h"
#include "closed_form/pendulum.h"
#include "kind.h"
#include "series/series.h"

enum { X, Y, N = 2 };

typedef struct given {      /* the parameters, and what evaluate() needs of them */
    double L;               /* m */
    double m;               /* kg */
    double g;               /* m/s^2 */
    double angle, rate;     /* rad from hanging, rad/s */
} given;

static int evaluate(const void *data, int want, double t, const double *p, const double *v, const zd_terms *out)
{
    (void)t;
    const given *q = data;
    if (want & ZD_M) memcpy(out->M, (double[]){q->m, 0, 0, q->m}, N * N * sizeof(double));
    if (want & ZD_FORCE) {
        out->f[X] = 0;
        out->f[Y] = -q->m * q->g;
    }
    if (want & ZD_PHI) *out->Phi = (p[X] * p[X] + p[Y] * p[Y] - q->L * q->L) / (2 * q->L);     /* (3) */
    if (want & ZD_C) {
        out->C[X] = p[X] / q->L;
        out->C[Y] = p[Y] / q->L;
    }
    if (want & ZD_XI) *out->xi = -(v[X] * v[X] + v[Y] * v[Y]) / q->L;                          /* (6) */
    if (want & ZD_POTENTIAL) *out->V = q->m * q->g * p[Y];
    return ZD_DONE;
}

static const char *prepare(const double *parameters, double *to)
{
    memcpy(to, parameters, sizeof(given));
    zd_pendulum_closed_form_constants(to);
    return NULL;
}

static void start(const double *parameters, double *p, double *v)
{
    const given *q = (const given *)parameters;
    p[X] = q->L * zd_sin(q->angle);
    p[Y] = -q->L * zd_cos(q->angle);
    v[X] = -q->rate * p[Y];
    v[Y] = q->rate * p[X];
}

static void draw(const double *data, const double *p, double *points)
{
    (void)data;
    memcpy(points, (double[]){0, 0, p[X], p[Y]}, 4 * sizeof *points);
}

static const double length[] = {1}, mass[] = {1}, gravity[] = {9.81}, horizontal[] = {0x1.921fb54442d18p+0}, rest[] = {0};

static const zd_parameter parameter[] = {
    {"length", "m", "of the rod", 1, ZD_POSITIVE, length},
    {"mass", "kg", "", 1, ZD_POSITIVE, mass},
    {"gravity", "m/s^2", "downwards, along -y", 1, ZD_ANY, gravity},
    {"angle", "rad", "at the start, from hanging straight down towards +x", 1, ZD_ANY, horizontal},
    {"rate", "rad/s", "its rate at the start", 1, ZD_ANY, rest},
};

static const zd_variable coordinate[] = {{"x", "m"}, {"y", "m"}};
static const zd_variable velocity[] = {{"x_dot", "m/s"}, {"y_dot", "m/s"}};
static const zd_variable constraint[] = {{"rod", "m"}};

const zd_kind zd_pendulum = {
    .card = {
        .name = "pendulum",
        .summary = "Point mass on a massless rod, in Cartesian coordinates.",
        .equations = "IFToMM benchmark A01",
        .description = "The smallest system that can drift from its constraint. The constraint is divided by twice the length, "
                       "so that its violation is the distance from the circle in m, and the multiplier is the tension of the rod "
                       "in N.",
        .reference = "IFToMM library of computational benchmark problems, A01; SUNDIALS, example cvPendulum",
    },
    .system = {
        .nq = N, .nv = N, .mh = 1,
        .provides = ZD_M | ZD_FORCE | ZD_PHI | ZD_C | ZD_XI | ZD_POTENTIAL | ZD_TIMELESS,
        .evaluate = evaluate,
        .series = &zd_pendulum_series,
        .closed_form = zd_pendulum_closed_form, .closed_forms = ZD_COUNT_OF_SETS,
    },
    ZD_PREPARED(ZD_PENDULUM_CLOSED_FORM_ENDS),
    .coordinate = coordinate, .velocity = velocity, .constraint = constraint,
    .points = 2, .dimension = 2, .draw = draw,
    .precise = &zd_pendulum_precise,
};
