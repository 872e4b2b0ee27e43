/* The paper's example 2: a mass on a spring, m xddot + k x = 0. One degree of freedom, no constraint. */
#include <string.h>

#include "../include/zerodrift/system.h"
#include "closed_form/oscillator.h"
#include "kind.h"
#include "series/series.h"

typedef struct given {      /* the parameters, and what evaluate() needs of them */
    double m;               /* kg */
    double k;               /* N/m */
    double x0, v0;          /* m, m/s */
} given;

static int evaluate(const void *data, int want, double t, const double *p, const double *v, const zd_terms *out)
{
    (void)t, (void)v;
    const given *q = data;
    if (want & ZD_M) *out->M = q->m;
    if (want & ZD_FORCE) *out->f = -q->k * *p;
    if (want & ZD_POTENTIAL) *out->V = 0.5 * q->k * *p * *p;
    return ZD_DONE;
}

static const char *prepare(const double *parameters, double *to)
{
    memcpy(to, parameters, sizeof(given));
    zd_oscillator_closed_form_constants(to);
    return NULL;
}

static void start(const double *parameters, double *p, double *v)
{
    const given *q = (const given *)parameters;
    *p = q->x0;
    *v = q->v0;
}

static void draw(const double *data, const double *p, double *points)
{
    (void)data;
    memcpy(points, (double[]){0, 0, *p, 0}, 4 * sizeof *points);
}

static const double mass[] = {1}, stiffness[] = {10}, position[] = {0.1}, rest[] = {0};

static const zd_parameter parameter[] = {
    {"mass", "kg", "", 1, ZD_POSITIVE, mass},
    {"stiffness", "N/m", "of the spring", 1, ZD_POSITIVE, stiffness},
    {"x0", "m", "position at the start, from where the spring is relaxed", 1, ZD_ANY, position},
    {"v0", "m/s", "velocity at the start", 1, ZD_ANY, rest},
};

static const zd_variable coordinate[] = {{"x", "m"}};
static const zd_variable velocity[] = {{"x_dot", "m/s"}};

const zd_kind zd_oscillator = {
    .card = {
        .name = "oscillator",
        .summary = "Mass on a spring, without constraints: the paper's example 2.",
        .equations = "section 4.2",
        .description = "One degree of freedom and no constraint, with a solution in closed form: it shows the effects of integrators and "
                       "energy correction alone.",
        .reference = "W. Blajer, Elimination of constraint violation and accuracy aspects in numerical simulation of multibody "
                     "systems, Multibody System Dynamics 7 (2002) 265-284, section 4.2",
    },
    .system = {
        .nq = 1, .nv = 1,
        .provides = ZD_M | ZD_FORCE | ZD_POTENTIAL | ZD_TIMELESS,
        .evaluate = evaluate,
        .series = &zd_oscillator_series,
        .closed_form = zd_oscillator_closed_form, .closed_forms = ZD_COUNT_OF_SETS,
    },
    ZD_PREPARED(ZD_OSCILLATOR_CLOSED_FORM_ENDS),
    .coordinate = coordinate, .velocity = velocity,
    .points = 2, .dimension = 2, .draw = draw,
    .precise = &zd_oscillator_precise,
};
