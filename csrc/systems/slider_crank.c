/* A damped slider-crank: the example idaSlCrank of SUNDIALS, which loses energy through its damper.
 *
 *            o.                          p = [q, x, phi]: crank angle, slider position, angle of the rod from pin to slider
 *         a /  \ .  b                    (the example's third letter, p, is the whole vector here)
 *          /~~~~\   .
 *     q   /       \    .                 A spring and a damper join the midpoints of crank and rod. The rod's mass is
 *        o----------[=]----> x           centred at the slider; the rod runs on beyond it by as much again,
 *                      \                 and there the constant force F pulls along x.
 *                        \--> F
 *
 *     T = (J1 qdot^2 + m xdot^2 + J2 phidot^2) / 2
 *     V = k (l - l0)^2 / 2 - F (x + b cos phi),       Edot = -c ldot^2
 */
#include <math.h>
#include <string.h>

#include "../include/zerodrift/sines.h"
#include "../include/zerodrift/system.h"
#include "../linalg/roots.h"
#include "../linalg/small.h"
#include "closed_form/slider_crank.h"
#include "kind.h"
#include "precise/precise.h"
#include "series/series.h"

enum { Q, X, ANGLE, N = 3 };

typedef struct given {          /* the parameters, and what evaluate() needs of them */
    double a, b;                /* m: crank, rod */
    double J1, m, J2;           /* kg m^2, kg, kg m^2 */
    double k, c, l0;            /* N/m, N s/m, m */
    double F;                   /* N */
    double angle, rate;         /* q(0), rad; its rate, rad/s */
} given;

typedef struct geometry {       /* valid while p does not change */
    double s1, c1, s2, c2;      /* sines and cosines of q and phi */
    double l, l_p[N];           /* length of the spring, m, and its gradient dl/dp */
} geometry;

static geometry locate(const given *k, const double *p)
{
    const double angle[] = {p[Q], p[ANGLE]};
    double s[2], c[2];
    zd_sines(2, angle, s, c);
    geometry g = {.s1 = s[0], .c1 = c[0], .s2 = s[1], .c2 = c[1]};
    double dx = p[X] - 0.5 * (k->a * g.c1 + k->b * g.c2);      /* from the crank's midpoint to the rod's */
    double dy = -0.5 * (k->a * g.s1 + k->b * g.s2);
    g.l = zd_hypotenuse(dx, dy);                                        /* at least (b - a) / 2 once the loop is closed */
    g.l_p[Q] = 0.5 * k->a * (dx * g.s1 - dy * g.c1) / g.l;
    g.l_p[X] = dx / g.l;
    g.l_p[ANGLE] = 0.5 * k->b * (dx * g.s2 - dy * g.c2) / g.l;
    return g;
}

static void write_force(const given *k, const geometry *g, const double *v, double *f)
{
    double pull = k->k * (g->l - k->l0) + k->c * zd_dot(N, g->l_p, v);
    for (int i = 0; i < N; i++) f[i] = -pull * g->l_p[i];
    f[X] += k->F;
    f[ANGLE] -= k->F * k->b * g->s2;
}

static void write_gradient(const given *k, const geometry *g, double *C)
{
    const double rows[] = {k->a * g->s1, 1, k->b * g->s2, -k->a * g->c1, 0, -k->b * g->c2};
    memcpy(C, rows, sizeof rows);
}

static void write_energy(const given *k, const geometry *g, int want, const double *p, const double *v, const zd_terms *out)
{
    double stretch = g->l - k->l0, speed = zd_dot(N, g->l_p, v);
    if (want & ZD_POTENTIAL) *out->V = 0.5 * k->k * stretch * stretch - k->F * (p[X] + k->b * g->c2);
    if (want & ZD_POWER) *out->power = -k->c * speed * speed;                                  /* Edot of (28) */
}

static int evaluate(const void *data, int want, double t, const double *p, const double *v, const zd_terms *out)
{
    (void)t;
    const given *k = data;
    geometry *g = (geometry *)out->scratch;
    if (want & ZD_MOVED) *g = locate(k, p);
    if (want & ZD_M) memcpy(out->M, (double[]){k->J1, 0, 0, 0, k->m, 0, 0, 0, k->J2}, N * N * sizeof(double));
    if (want & ZD_FORCE) write_force(k, g, v, out->f);
    if (want & ZD_PHI) {                                                                        /* (3) */
        out->Phi[0] = p[X] - k->a * g->c1 - k->b * g->c2;
        out->Phi[1] = -k->a * g->s1 - k->b * g->s2;
    }
    if (want & ZD_C) write_gradient(k, g, out->C);
    if (want & ZD_XI) {                                                                         /* (6) */
        double w1 = k->a * v[Q] * v[Q], w2 = k->b * v[ANGLE] * v[ANGLE];
        out->xi[0] = -w1 * g->c1 - w2 * g->c2;
        out->xi[1] = -w1 * g->s1 - w2 * g->s2;
    }
    if (want & (ZD_POTENTIAL | ZD_POWER)) write_energy(k, g, want, p, v, out);
    return ZD_DONE;
}

/* So phi stays within a quarter turn and the spring's ends apart. */
static const char *prepare(const double *parameters, double *to)
{
    const given *k = (const given *)parameters;
    if (!(k->b > k->a)) return "the rod must be longer than the crank: else the crank cannot turn all the way around";
    memcpy(to, parameters, sizeof *k);
    zd_slider_crank_closed_form_constants(to);
    return NULL;
}

static void start(const double *parameters, double *p, double *v)
{
    const given *k = (const given *)parameters;
    p[Q] = k->angle;
    p[ANGLE] = asin(-k->a / k->b * zd_sin(p[Q]));
    p[X] = k->a * zd_cos(p[Q]) + k->b * zd_cos(p[ANGLE]);
    v[Q] = k->rate;
    v[ANGLE] = -k->a * zd_cos(p[Q]) / (k->b * zd_cos(p[ANGLE])) * v[Q];
    v[X] = -k->a * zd_sin(p[Q]) * v[Q] - k->b * zd_sin(p[ANGLE]) * v[ANGLE];
}

/* Crank, rod with its far end, pen up, spring. */
static void draw(const double *data, const double *p, double *points)
{
    const given *k = (const given *)data;
    double ax = k->a * zd_cos(p[Q]), ay = k->a * zd_sin(p[Q]), bx = k->b * zd_cos(p[ANGLE]), by = k->b * zd_sin(p[ANGLE]);
    const double line[] = {0, 0, ax, ay, p[X], 0, p[X] + bx, by, NAN, NAN, ax / 2, ay / 2, p[X] - bx / 2, -by / 2};
    memcpy(points, line, sizeof line);
}

static const double crank[] = {0.5}, quarter[] = {0x1.921fb54442d18p+0}, one[] = {1}, two[] = {2}, rest[] = {0};

static const zd_parameter parameter[] = {
    {"crank", "m", "radius", 1, ZD_POSITIVE, crank},
    {"rod", "m", "length from the crank's pin to the slider, longer than the crank", 1, ZD_POSITIVE, one},
    {"crank_inertia", "kg m^2", "about the crank's bearing", 1, ZD_POSITIVE, one},
    {"mass", "kg", "of slider and rod, centred at the slider", 1, ZD_POSITIVE, one},
    {"rod_inertia", "kg m^2", "about the slider", 1, ZD_POSITIVE, two},
    {"stiffness", "N/m", "of the spring between the midpoints of crank and rod", 1, ZD_NOT_NEGATIVE, one},
    {"damping", "N s/m", "of the damper beside it", 1, ZD_NOT_NEGATIVE, one},
    {"relaxed_length", "m", "of the spring", 1, ZD_NOT_NEGATIVE, one},
    {"force", "N", "along x at the far end of the rod", 1, ZD_ANY, one},
    {"crank_angle", "rad", "at the start", 1, ZD_ANY, quarter},
    {"crank_rate", "rad/s", "at the start", 1, ZD_ANY, rest},
};

static const zd_variable coordinate[] = {{"crank", "rad"}, {"x", "m"}, {"rod", "rad"}};
static const zd_variable velocity[] = {{"crank_dot", "rad/s"}, {"x_dot", "m/s"}, {"rod_dot", "rad/s"}};
static const zd_variable constraint[] = {{"closure_x", "m"}, {"closure_y", "m"}};

const zd_kind zd_slider_crank = {
    .card = {
        .name = "slider_crank",
        .summary = "Slider-crank with a spring, a damper and a constant force.",
        .equations = "SUNDIALS idaSlCrank",
        .description = "A crank, a rod and a slider. A spring and a damper join the midpoints of crank and rod, and a constant "
                       "force pulls at the rod's far end. It loses energy through its damper, which is accounted for by (28).",
        .reference = "SUNDIALS, IDA, example idaSlCrank",
    },
    .system = {
        .nq = N, .nv = N, .mh = 2,
        .provides = ZD_M | ZD_FORCE | ZD_PHI | ZD_C | ZD_XI | ZD_POTENTIAL | ZD_POWER | ZD_TIMELESS,
        .scratch = sizeof(geometry) / sizeof(double),
        .evaluate = evaluate,
        .series = &zd_slider_crank_series,
        .closed_form = zd_slider_crank_closed_form, .closed_forms = ZD_COUNT_OF_SETS,
    },
    ZD_PREPARED_DOUBLES(ZD_SLIDER_CRANK_CLOSED_FORM_ENDS),
    .coordinate = coordinate, .velocity = velocity, .constraint = constraint,
    .points = 7, .dimension = 2, .draw = draw,
    .precise = &zd_slider_crank_precise,
};
