/* A disc that rolls on a plane and is kept upright: the textbooks' first nonholonomic system.
 *
 *     p = [x, y, phi, theta]: point of contact, heading and rotation
 *
 *     xdot - R thetadot cos phi = 0,      ydot - R thetadot sin phi = 0
 *
 * It turns and rolls at constant rates, in a circle. Bloch, Nonholonomic Mechanics and Control, 2015, section 1.4. A disc that
 * nothing keeps upright (rolling_disc) leans as soon as it turns. Nothing pulls it: V = 0 is declared so that its energy can
 * be watched.
 */
#include <math.h>
#include <string.h>

#include "../include/zerodrift/sines.h"
#include "../include/zerodrift/system.h"
#include "closed_form/vertical_disc.h"
#include "disc.h"
#include "kind.h"
#include "precise/precise.h"
#include "series/series.h"

enum { X, Y, PHI, THETA, N };

typedef struct given {          /* the parameters, and what evaluate() needs of them */
    double m, R;                /* kg, m */
    double Ia, It;              /* kg m^2, about the axle and about the vertical diameter */
    double heading;             /* rad */
    double turn_rate, roll_rate;
} given;

typedef struct sines {          /* sine and cosine of phi, valid while p does not change */
    double s, c;
} sines;

static void write_mass(const given *k, double *M)
{
    const double diagonal[N] = {k->m, k->m, k->It, k->Ia};
    memset(M, 0, N * N * sizeof *M);
    for (int i = 0; i < N; i++) M[i * N + i] = diagonal[i];
}

static int evaluate(const void *data, int want, double t, const double *p, const double *v, const zd_terms *out)
{
    (void)t;
    const given *k = data;
    sines *h = (sines *)out->scratch;
    if (want & ZD_MOVED) zd_sines(1, p + PHI, &h->s, &h->c);
    if (want & ZD_M) write_mass(k, out->M);
    if (want & ZD_C) {                                                                          /* (5) */
        const double rows[] = {1, 0, 0, -k->R * h->c, 0, 1, 0, -k->R * h->s};
        memcpy(out->C, rows, sizeof rows);
    }
    if (want & ZD_XI) {                                                                         /* (6) */
        double turning = k->R * v[THETA] * v[PHI];
        out->xi[0] = -turning * h->s;
        out->xi[1] = turning * h->c;
    }
    if (want & ZD_POTENTIAL) *out->V = 0;
    return ZD_DONE;
}

static const char *prepare(const double *parameters, double *to)
{
    given k;
    memcpy(&k, parameters, sizeof k);
    double thin = k.m * k.R * k.R / 4;
    if (isnan(k.Ia)) k.Ia = 2 * thin;
    if (isnan(k.It)) k.It = thin;
    memcpy(to, &k, sizeof k);
    zd_vertical_disc_closed_form_constants(to);
    return NULL;
}

static void start(const double *parameters, double *p, double *v)
{
    const given *k = (const given *)parameters;
    double speed = k->R * k->roll_rate;
    memcpy(p, (double[N]){[PHI] = k->heading}, N * sizeof *p);
    memcpy(v, (double[N]){speed * zd_cos(k->heading), speed * zd_sin(k->heading), k->turn_rate, k->roll_rate}, N * sizeof *v);
}

static void draw(const double *data, const double *p, double *points)
{
    const given *k = (const given *)data;
    const double centre[] = {p[X], p[Y], k->R}, up[] = {0, 0, 1}, ahead[] = {zd_cos(p[PHI]), zd_sin(p[PHI]), 0};
    zd_draw_disc(centre, k->R, up, ahead, p[THETA], points);
}

static const double mass[] = {1}, radius[] = {1}, zero[] = {0}, turning[] = {2}, rolling[] = {1};

static const zd_parameter parameter[] = {
    {"mass", "kg", "", 1, ZD_POSITIVE, mass},
    {"radius", "m", "", 1, ZD_POSITIVE, radius},
    {"axle_inertia", "kg m^2", "about the axle; left out: thin and uniform, m R^2 / 2", 1, ZD_POSITIVE, NULL},
    {"diameter_inertia", "kg m^2", "about a diameter; left out: thin and uniform, m R^2 / 4", 1, ZD_POSITIVE, NULL},
    {"heading", "rad", "at the start, from the x axis", 1, ZD_ANY, zero},
    {"turn_rate", "rad/s", "about the vertical; it stays", 1, ZD_ANY, turning},
    {"roll_rate", "rad/s", "about the axle; it stays", 1, ZD_ANY, rolling},
};

static const zd_variable coordinate[] = {{"x", "m"}, {"y", "m"}, {"phi", "rad"}, {"theta", "rad"}};
static const zd_variable velocity[] = {{"x_dot", "m/s"}, {"y_dot", "m/s"}, {"phi_dot", "rad/s"}, {"theta_dot", "rad/s"}};
static const zd_variable constraint[] = {{"slip_x", "m/s"}, {"slip_y", "m/s"}};

const zd_kind zd_vertical_disc = {
    .card = {
        .name = "vertical_disc",
        .summary = "Disc that rolls on a plane and is kept upright.",
        .equations = "Bloch, section 1.4",
        .description = "A disc rolls on a plane, and something keeps it upright: the textbooks' first nonholonomic system. It "
                       "turns and rolls at constant rates, in a circle. V = 0 is declared so that its energy can be watched.",
        .reference = "A. M. Bloch, Nonholonomic Mechanics and Control, 2nd edition, Springer, 2015, section 1.4",
    },
    .system = {
        .nq = N, .nv = N, .mn = 2,
        .provides = ZD_M | ZD_C | ZD_XI | ZD_POTENTIAL | ZD_TIMELESS,
        .scratch = sizeof(sines) / sizeof(double),
        .evaluate = evaluate,
        .series = &zd_vertical_disc_series,
        .closed_form = zd_vertical_disc_closed_form, .closed_forms = ZD_COUNT_OF_SETS,
    },
    ZD_PREPARED_DOUBLES(ZD_VERTICAL_DISC_CLOSED_FORM_ENDS),
    .coordinate = coordinate, .velocity = velocity, .constraint = constraint,
    .points = ZD_DISC_POINTS, .dimension = 3, .draw = draw,
    .precise = &zd_vertical_disc_precise,
};
