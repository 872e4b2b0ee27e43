/* A knife edge, or skate, on an inclined plane: it slides along itself and turns, but does not slip sideways.
 *
 *     o------------> x  down the slope        p = [x, y, phi], u = xdot, v = ydot
 *     |  \ phi
 *     |    \                                  u sin phi - v cos phi = 0
 *     y     edge
 *
 * Left alone at the top with some spin it does not run down: it drifts sideways on a cycloid. Bloch, Nonholonomic Mechanics and
 * Control, 2nd edition 2015, section 1.6; with that row, lambda = 2 m g sin(incline) sin phi from a start at phi = 0 at rest.
 */
#include <math.h>
#include <string.h>

#include "../include/zerodrift/sines.h"
#include "../include/zerodrift/system.h"
#include "closed_form/knife_edge.h"
#include "kind.h"
#include "series/series.h"

enum { X, Y, PHI, N };

typedef struct given {
    double m, I;            /* kg, kg m^2 */
    double g, incline;      /* m/s^2, rad */
    double heading, speed, turn_rate;   /* rad; m/s, along the edge; rad/s */
} given;

typedef struct constants {
    double m, I;
    double weight;          /* N, what of it pulls down the slope */
} constants;

typedef struct sines {      /* sine and cosine of phi, valid while p does not change */
    double s, c;
} sines;

static int evaluate(const void *data, int want, double t, const double *p, const double *v, const zd_terms *out)
{
    (void)t;
    const constants *k = data;
    sines *a = (sines *)out->scratch;
    if (want & ZD_MOVED) zd_sines(1, p + PHI, &a->s, &a->c);
    if (want & ZD_M) memcpy(out->M, (double[]){k->m, 0, 0, 0, k->m, 0, 0, 0, k->I}, N * N * sizeof(double));
    if (want & ZD_FORCE) memcpy(out->f, (double[]){k->weight, 0, 0}, N * sizeof(double));
    if (want & ZD_C) memcpy(out->C, (double[]){a->s, -a->c, 0}, N * sizeof(double));           /* (5) */
    if (want & ZD_XI) *out->xi = -v[PHI] * (a->c * v[X] + a->s * v[Y]);                        /* (6) */
    if (want & ZD_COMPLEMENT) memcpy(out->D, (double[]){a->c, 0, a->s, 0, 0, 1}, 2 * N * sizeof(double));      /* (14) */
    if (want & ZD_GAMMA) {                                              /* (15): Ddot u */
        double along = a->c * v[X] + a->s * v[Y], turn = v[PHI];
        memcpy(out->gamma, (double[]){-along * turn * a->s, along * turn * a->c, 0}, N * sizeof(double));
    }
    if (want & ZD_POTENTIAL) *out->V = -k->weight * p[X];
    return ZD_DONE;
}

static const char *prepare(const double *parameters, double *to)
{
    const given *q = (const given *)parameters;
    const constants k = {q->m, q->I, q->m * q->g * zd_sin(q->incline)};
    memcpy(to, &k, sizeof k);
    zd_knife_edge_closed_form_constants(to);
    return NULL;
}

static void start(const double *parameters, double *p, double *v)
{
    const given *q = (const given *)parameters;
    p[X] = p[Y] = 0;
    p[PHI] = q->heading;
    v[X] = q->speed * zd_cos(q->heading);
    v[Y] = q->speed * zd_sin(q->heading);
    v[PHI] = q->turn_rate;
}

enum { POINTS = 5 };

/* An arrow as long as the slender rod of this mass and inertia. */
static void draw(const double *data, const double *p, double *points)
{
    const constants *k = (const constants *)data;
    double l = sqrt(12 * k->I / k->m), tip = 0.5 * l, back = 0.3 * l, wide = 0.08 * l;
    double s = zd_sin(p[PHI]), c = zd_cos(p[PHI]);
    const double arrow[POINTS][2] = {{-tip, 0}, {tip, 0}, {back, wide}, {back, -wide}, {tip, 0}};
    for (int i = 0; i < POINTS; i++) {
        points[2 * i] = p[X] + c * arrow[i][0] - s * arrow[i][1];
        points[2 * i + 1] = p[Y] + s * arrow[i][0] + c * arrow[i][1];
    }
}

static const double mass[] = {1.25}, inertia[] = {0.13}, gravity[] = {9.81}, eighth[] = {0x1.921fb54442d18p-1}, zero[] = {0},
                    sixth[] = {0x1.0c152382d7366p+0};

static const zd_parameter parameter[] = {
    {"mass", "kg", "", 1, ZD_POSITIVE, mass},
    {"inertia", "kg m^2", "about the normal of the plane", 1, ZD_POSITIVE, inertia},
    {"gravity", "m/s^2", "", 1, ZD_ANY, gravity},
    {"incline", "rad", "of the plane, downwards along +x", 1, ZD_ANY, eighth},
    {"heading", "rad", "at the start, from the x axis", 1, ZD_ANY, zero},
    {"speed", "m/s", "along the edge at the start", 1, ZD_ANY, zero},
    {"turn_rate", "rad/s", "at the start; it stays", 1, ZD_ANY, sixth},
};

static const zd_variable coordinate[] = {{"x", "m"}, {"y", "m"}, {"phi", "rad"}};
static const zd_variable velocity[] = {{"x_dot", "m/s"}, {"y_dot", "m/s"}, {"phi_dot", "rad/s"}};
static const zd_variable constraint[] = {{"slip", "m/s"}};

const zd_kind zd_knife_edge = {
    .card = {
        .name = "knife_edge",
        .summary = "Knife edge on an inclined plane: one nonholonomic constraint.",
        .equations = "Bloch, section 1.6",
        .description = "A skate slides along itself and turns, but does not slip sideways. Released at the top of the plane with some spin "
                       "it does not slide down: it moves sideways on a cycloid.",
        .reference = "A. M. Bloch, Nonholonomic Mechanics and Control, 2nd edition, Springer, 2015, section 1.6",
    },
    .system = {
        .nq = N, .nv = N, .mn = 1,
        .provides = ZD_M | ZD_FORCE | ZD_C | ZD_XI | ZD_POTENTIAL | ZD_COMPLEMENT | ZD_GAMMA | ZD_TIMELESS,
        .scratch = sizeof(sines) / sizeof(double),
        .evaluate = evaluate,
        .series = &zd_knife_edge_series,
        .closed_form = zd_knife_edge_closed_form, .closed_forms = ZD_COUNT_OF_SETS,
    },
    ZD_PREPARED(ZD_KNIFE_EDGE_CLOSED_FORM_ENDS),
    .coordinate = coordinate, .velocity = velocity, .constraint = constraint,
    .points = POINTS, .dimension = 2, .draw = draw,
    .precise = &zd_knife_edge_precise,
};
