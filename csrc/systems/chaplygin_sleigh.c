/* The Chaplygin sleigh: a body on a frictionless plane, with one knife edge behind its centre of mass.
 *
 *     edge ------a----> centre of mass        p = [x, y, phi], the edge and the heading
 *     (x, y)                                  -xdot sin phi + ydot cos phi = 0
 *
 * Its energy is conserved, and yet the motion converges to straight motion with the centre of mass ahead, as is possible in
 * nonholonomic systems only. Neimark and Fufaev, Dynamics of Nonholonomic Systems, 1972; Bloch, Nonholonomic Mechanics and
 * Control, 2015, section 1.7. No forces are applied: V = 0 is declared so that the energy error is recorded.
 */
#include "../include/zerodrift/sines.h"
#include "closed_form/chaplygin_sleigh.h"
#include "kind.h"
#include "precise/precise.h"
#include "series/series.h"
#include "skate.h"

enum { X = ZD_SKATE_X, Y = ZD_SKATE_Y, PHI = ZD_SKATE_PHI, N = ZD_SKATE_N };

typedef struct given {      /* the parameters, and what evaluate() needs of them */
    double m, I;            /* kg, kg m^2 about the centre of mass */
    double a;               /* m */
    zd_skate_launch launch;
} given;

typedef struct sines {      /* sine and cosine of phi, valid while p does not change */
    double s, c;
} sines;

static void write_mass(const given *k, const sines *h, double *M)
{
    double ma = k->m * k->a;
    const double rows[] = {
        k->m, 0, -ma * h->s,
        0, k->m, ma * h->c,
        -ma * h->s, ma * h->c, k->I + ma * k->a,
    };
    memcpy(M, rows, sizeof rows);
}

static int evaluate(const void *data, int want, double t, const double *p, const double *v, const zd_terms *out)
{
    (void)t;
    const given *k = data;
    sines *h = (sines *)out->scratch;
    if (want & ZD_MOVED) zd_sines(1, p + PHI, &h->s, &h->c);
    if (want & ZD_M) write_mass(k, h, out->M);
    if (want & ZD_BIAS) {
        double centripetal = k->m * k->a * v[PHI] * v[PHI];
        memcpy(out->d, (double[]){-centripetal * h->c, -centripetal * h->s, 0}, N * sizeof(double));
    }
    if (want & ZD_C) memcpy(out->C, (double[]){-h->s, h->c, 0}, N * sizeof(double));           /* (5) */
    if (want & ZD_XI) *out->xi = v[PHI] * (h->c * v[X] + h->s * v[Y]);                         /* (6) */
    if (want & ZD_COMPLEMENT) zd_skate_complement(h->s, h->c, out->D);
    if (want & ZD_GAMMA) zd_skate_gamma(h->s, h->c, v, out->gamma);
    if (want & ZD_POTENTIAL) *out->V = 0;
    return ZD_DONE;
}

static const char *prepare(const double *parameters, double *to)
{
    memcpy(to, parameters, sizeof(given));
    zd_chaplygin_sleigh_closed_form_constants(to);
    return NULL;
}

static void start(const double *parameters, double *p, double *v)
{
    zd_skate_start(&((const given *)parameters)->launch, p, v);
}

enum { POINTS = 7 };

/* The edge, pen up, and a triangle whose one corner is the edge and whose centroid is the centre of mass. */
static void draw(const double *data, const double *p, double *points)
{
    const given *k = (const given *)data;
    double half = 0.5 * sqrt(k->I / k->m), far = 1.5 * k->a;
    const double outline[POINTS][2] = {{-half, 0}, {half, 0}, {NAN, NAN}, {0, 0}, {far, half}, {far, -half}, {0, 0}};
    zd_skate_draw(POINTS, outline, p, points);
}

static const double mass[] = {1}, inertia[] = {0.1}, ahead[] = {0.1}, zero[] = {0}, backwards[] = {-1}, turning[] = {1};

static const zd_parameter parameter[] = {
    {"mass", "kg", "", 1, ZD_POSITIVE, mass},
    {"inertia", "kg m^2", "about the centre of mass", 1, ZD_POSITIVE, inertia},
    {"offset", "m", "of the centre of mass ahead of the edge", 1, ZD_ANY, ahead},
    {"heading", "rad", "at the start, from the x axis", 1, ZD_ANY, zero},
    {"speed", "m/s", "along the edge at the start", 1, ZD_ANY, backwards},
    {"turn_rate", "rad/s", "at the start", 1, ZD_ANY, turning},
};

const zd_kind zd_chaplygin_sleigh = {
    .card = {
        .name = "chaplygin_sleigh",
        .summary = "Sleigh on one edge: keeps its energy, yet settles into straight motion.",
        .equations = "Bloch, section 1.7",
        .description = "A body slides on a frictionless plane, with one knife edge behind its centre of mass. Its energy is conserved, "
                       "and yet its motion converges to straight motion with the centre of mass ahead, as is possible in "
                       "nonholonomic systems only. V = 0 is declared so that the energy error is recorded.",
        .reference = "Y. I. Neimark, N. A. Fufaev, Dynamics of Nonholonomic Systems, AMS, 1972; A. M. Bloch, Nonholonomic "
                     "Mechanics and Control, 2nd edition, Springer, 2015, section 1.7",
    },
    .system = {
        .nq = N, .nv = N, .mn = 1,
        .provides = ZD_M | ZD_BIAS | ZD_C | ZD_XI | ZD_POTENTIAL | ZD_COMPLEMENT | ZD_GAMMA | ZD_TIMELESS,
        .scratch = sizeof(sines) / sizeof(double),
        .evaluate = evaluate,
        .series = &zd_chaplygin_sleigh_series,
        .closed_form = zd_chaplygin_sleigh_closed_form, .closed_forms = ZD_COUNT_OF_SETS,
    },
    ZD_PREPARED_DOUBLES(ZD_CHAPLYGIN_SLEIGH_CLOSED_FORM_ENDS),
    .coordinate = zd_skate_coordinate, .velocity = zd_skate_velocity, .constraint = zd_skate_constraint,
    .points = POINTS, .dimension = 2, .draw = draw,
    .precise = &zd_chaplygin_sleigh_precise,
};
