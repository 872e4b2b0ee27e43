/* The paper's example 1: a four-bar mechanism under gravity, cut open at its last joint (Figure 4).
 *
 *      2      alpha_2      3         p = [alpha_1, alpha_2, alpha_3], absolute angles from the x axis, v = pdot;
 *      o------------------o          link 1 turns about the origin, and the tip of link 3 is held at (l0, 0).
 *     /                    \         All from section 4.1, with the inertias J_i about the link midpoints.
 *    / alpha_1      alpha_3 \
 *   o                        o  (l0, 0)
 */
#include <math.h>
#include <stddef.h>
#include <string.h>

#include "../include/zerodrift/sines.h"
#include "../include/zerodrift/system.h"
#include "../linalg/roots.h"
#include "../linalg/small.h"
#include "closed_form/four_bar.h"
#include "kind.h"
#include "series/series.h"

static const double TURN = 0x1.921fb54442d18p+2;     /* 2 pi */

static const double COSINE_ROUNDING = 8 * 0x1p-52;  /* rounding error of a cosine */
static const double FLAT = 1e-9;                    /* gap allowed with all links in line, relative to the ground link */

enum { ALPHA_1, ALPHA_2, ALPHA_3, N };
enum { OF_CLOSED_FORM = 11 };   /* number of parameters, the first, of the closed-form functions */

/* parameters, in the order of the table at the end */
typedef struct given {
    double l[4];        /* m: l0 ... l3 */
    double m[N];        /* kg */
    double J[N];        /* kg m^2 */
    double g;           /* m/s^2 */
    double crossed;
    double angle, rate; /* alpha_1(0), rad; its rate, rad/s */
} given;

/* constants of evaluate(), from the parameters */
typedef struct constants {
    double l0, l[N];
    double side;            /* side of the diagonal with joint 3: 1 open, -1 crossed; 0: changes where both assemblies meet */
    double diagonal[N];     /* M_ii, kg m^2 */
    double k12, k13, k23;   /* M_ij / cos(alpha_j - alpha_i), kg m^2 */
    double weight[N];       /* -f_i / cos(alpha_i), N m */
} constants;

_Static_assert(sizeof(constants) == ZD_FOUR_BAR_CLOSED_FORM_BEGINS * sizeof(double), "where closed-form functions look for theirs");

typedef struct sines {          /* valid while p does not change */
    double s[N], c[N];
} sines;

static void write_mass(const constants *k, const sines *a, double *M)
{
    const double *s = a->s, *c = a->c;
    for (int i = 0; i < N; i++) M[i * N + i] = k->diagonal[i];
    M[0 * N + 1] = M[1 * N + 0] = k->k12 * (c[1] * c[0] + s[1] * s[0]);
    M[0 * N + 2] = M[2 * N + 0] = k->k13 * (c[2] * c[0] + s[2] * s[0]);
    M[1 * N + 2] = M[2 * N + 1] = k->k23 * (c[2] * c[1] + s[2] * s[1]);
}

static void write_bias(const constants *k, const sines *a, const double *v, double *d)
{
    const double *s = a->s, *c = a->c;
    double w1 = v[0] * v[0], w2 = v[1] * v[1], w3 = v[2] * v[2];
    double s21 = k->k12 * (s[1] * c[0] - c[1] * s[0]);
    double s31 = k->k13 * (s[2] * c[0] - c[2] * s[0]);
    double s32 = k->k23 * (s[2] * c[1] - c[2] * s[1]);
    d[0] = -s21 * w2 - s31 * w3;
    d[1] = s21 * w1 - s32 * w3;
    d[2] = s31 * w1 + s32 * w2;
}

static void write_closure(const constants *k, const sines *a, double *Phi)
{
    const double *l = k->l, *s = a->s, *c = a->c;
    Phi[0] = l[0] * c[0] + l[1] * c[1] + l[2] * c[2] - k->l0;
    Phi[1] = l[0] * s[0] + l[1] * s[1] + l[2] * s[2];
}

static void write_closure_bias(const constants *k, const sines *a, const double *v, double *xi)
{
    double pull[N];     /* l_i v_i^2, m/s^2 */
    for (int i = 0; i < N; i++) pull[i] = k->l[i] * v[i] * v[i];
    xi[0] = zd_dot(N, pull, a->c);
    xi[1] = zd_dot(N, pull, a->s);
}

static int evaluate(const void *data, int want, double t, const double *p, const double *v, const zd_terms *out)
{
    (void)t;
    const constants *k = data;
    sines *kept = (sines *)out->scratch;
    sines a;        /* a local, not read back from where it is kept */
    if (want & ZD_MOVED) {
        zd_sines(N, p, a.s, a.c);
        *kept = a;
    } else {
        a = *kept;
    }
    if (want & ZD_M) write_mass(k, &a, out->M);
    if (want & ZD_BIAS) write_bias(k, &a, v, out->d);
    if (want & ZD_FORCE)
        for (int i = 0; i < N; i++) out->f[i] = -k->weight[i] * a.c[i];
    if (want & ZD_PHI) write_closure(k, &a, out->Phi);
    if (want & ZD_C)
        for (int i = 0; i < N; i++) {
            out->C[i] = -k->l[i] * a.s[i];
            out->C[N + i] = k->l[i] * a.c[i];
        }
    if (want & ZD_XI) write_closure_bias(k, &a, v, out->xi);
    if (want & ZD_POTENTIAL) *out->V = zd_dot(N, k->weight, a.s);
    return ZD_DONE;
}

/* ---- alpha_2 and alpha_3 from alpha_1 ---- */

/* alpha_2, alpha_3 close the triangle of l2, l3 and the diagonal from joint 2 to (l0, 0), with joint 3 on the given side of it (1 or -1),
 * or with side 0 on its side by the present alpha_2. Returns false if the links do not reach. */
static int close_loop(double l0, const double *l, double side, double *p)
{
    double x = l0 - l[0] * zd_cos(p[ALPHA_1]), y = -l[0] * zd_sin(p[ALPHA_1]), diagonal = zd_hypotenuse(x, y), direction = atan2(y, x);
    double cosine = (l[1] * l[1] + diagonal * diagonal - l[2] * l[2]) / (2 * l[1] * diagonal);
    if (!(fabs(cosine) <= 1 + COSINE_ROUNDING)) return 0;
    if (side == 0) side = p[ALPHA_2] - direction < TURN * round((p[ALPHA_2] - direction) / TURN) ? -1 : 1;
    p[ALPHA_2] = direction + side * acos(fmax(-1, fmin(cosine, 1)));
    p[ALPHA_3] = atan2(y - l[1] * zd_sin(p[ALPHA_2]), x - l[1] * zd_cos(p[ALPHA_2]));
    return 1;
}

/* (18), q = alpha_1: angles keep their numbers of turns. */
static int embed(const void *data, double t, const double *q, double *p)
{
    (void)t;
    const constants *k = data;
    double before[N] = {p[0], p[1], p[2]};
    p[ALPHA_1] = q[0];
    if (!close_loop(k->l0, k->l, k->side, p)) return ZD_NO_EMBEDDING;
    for (int i = ALPHA_2; i < N; i++) p[i] += TURN * round((before[i] - p[i]) / TURN);
    return ZD_DONE;
}

/* ---- the start ---- */

static void close_rates(const given *q, const double *p, double *v)
{
    double sine = zd_sin(p[ALPHA_3] - p[ALPHA_2]);
    v[ALPHA_1] = q->rate;
    v[ALPHA_2] = q->rate * q->l[1] / q->l[2] * zd_sin(p[ALPHA_1] - p[ALPHA_3]) / sine;
    v[ALPHA_3] = q->rate * q->l[1] / q->l[3] * zd_sin(p[ALPHA_2] - p[ALPHA_1]) / sine;
}

static void start(const double *parameters, double *p, double *v)
{
    const given *q = (const given *)parameters;
    p[ALPHA_1] = q->angle;
    close_loop(q->l[0], q->l + 1, q->crossed != 0 ? -1 : 1, p);
    close_rates(q, p, v);
}

/* True if all links can be in line: the two assemblies coincide there. */
static int can_be_flat(const double *l)
{
    for (int signs = 0; signs < 8; signs++) {
        double sum = l[0];
        for (int i = 0; i < N; i++) sum += signs & 1 << i ? l[i + 1] : -l[i + 1];
        if (fabs(sum) <= FLAT * l[0]) return 1;
    }
    return 0;
}

/* Moment of inertia of a link about its midpoint; by default that of a slender rod. */
static double inertia(const given *q, int i)
{
    return isnan(q->J[i]) ? q->m[i] * q->l[i + 1] * q->l[i + 1] / 12 : q->J[i];
}

static const char *prepare(const double *parameters, double *to)
{
    const given *q = (const given *)parameters;
    double p[N] = {q->angle};
    if (!close_loop(q->l[0], q->l + 1, q->crossed != 0 ? -1 : 1, p))
        return "links of these lengths cannot close the loop at this crank_angle";
    if (!(fabs(zd_sin(p[ALPHA_3] - p[ALPHA_2])) > 1e-8))
        return "links 2 and 3 are in line at this crank_angle: there the crank does not determine the motion";
    double *of_closed_form = to + ZD_FOUR_BAR_CLOSED_FORM_BEGINS, *J = of_closed_form + offsetof(given, J) / sizeof *to;
    memcpy(of_closed_form, q, OF_CLOSED_FORM * sizeof *to);
    for (int i = 0; i < N; i++) J[i] = inertia(q, i);
    zd_four_bar_closed_form_constants(of_closed_form);
    double l1 = q->l[1], l2 = q->l[2], l3 = q->l[3], m1 = q->m[0], m2 = q->m[1], m3 = q->m[2];
    const constants k = {
        .l0 = q->l[0],
        .l = {l1, l2, l3},
        .side = can_be_flat(q->l) ? 0 : q->crossed != 0 ? -1 : 1,
        .diagonal = {J[0] + (0.25 * m1 + m2 + m3) * l1 * l1, J[1] + (0.25 * m2 + m3) * l2 * l2, J[2] + 0.25 * m3 * l3 * l3},
        .k12 = (0.5 * m2 + m3) * l1 * l2,
        .k13 = 0.5 * m3 * l1 * l3,
        .k23 = 0.5 * m3 * l2 * l3,
        .weight = {(0.5 * m1 + m2 + m3) * q->g * l1, (0.5 * m2 + m3) * q->g * l2, 0.5 * m3 * q->g * l3},
    };
    memcpy(to, &k, sizeof k);
    return NULL;
}

static void draw(const double *data, const double *p, double *points)
{
    const constants *k = (const constants *)data;
    points[0] = points[1] = 0;
    for (int i = 0; i < N; i++) {
        points[2 * i + 2] = points[2 * i] + k->l[i] * zd_cos(p[i]);
        points[2 * i + 3] = points[2 * i + 1] + k->l[i] * zd_sin(p[i]);
    }
}

static const zd_variable coordinate[] = {{"alpha1", "rad"}, {"alpha2", "rad"}, {"alpha3", "rad"}};
static const zd_variable velocity[] = {{"alpha1_dot", "rad/s"}, {"alpha2_dot", "rad/s"}, {"alpha3_dot", "rad/s"}};
static const zd_variable constraint[] = {{"closure_x", "m"}, {"closure_y", "m"}};

static const zd_parameter parameter[] = {
    {"lengths", "m", "ground l0 and links l1, l2, l3", 4, ZD_POSITIVE, (const double[]){1, 0.3, 1, 0.6}},
    {"masses", "kg", "of links 1, 2, 3", 3, ZD_POSITIVE, (const double[]){1.5, 5, 3}},
    {"inertias", "kg m^2", "about the link midpoints; left out: slender rods, m l^2 / 12", 3, ZD_NOT_NEGATIVE, NULL},
    {"gravity", "m/s^2", "downwards, along -y", 1, ZD_ANY, (const double[]){9.81}},
    {"assembly", "", "open crossed", 1, ZD_CHOICE, (const double[]){0}},
    {"crank_angle", "rad", "alpha1 at the start", 1, ZD_ANY, (const double[]){0x1.921fb54442d18p+0}},
    {"crank_rate", "rad/s", "its rate at the start", 1, ZD_ANY, (const double[]){1}},
};

const zd_kind zd_four_bar = {
    .card = {
        .name = "four_bar",
        .summary = "Four-bar mechanism under gravity, cut open at its last joint: the paper's example 1.",
        .equations = "section 4.1",
        .description = "Three links that turn about joints, described by their absolute angles from the x axis; the tip of the "
                       "last is held at a fixed point. One degree of freedom, two constraints. It is the paper's example for "
                       "drift, stabilization and energy.",
        .reference = "W. Blajer, Elimination of constraint violation and accuracy aspects in numerical simulation of multibody "
                     "systems, Multibody System Dynamics 7 (2002) 265-284, section 4.1",
    },
    .system = {
        .nq = N, .nv = N, .mh = 2,
        .provides = ZD_M | ZD_BIAS | ZD_FORCE | ZD_PHI | ZD_C | ZD_XI | ZD_POTENTIAL | ZD_TIMELESS,
        .scratch = sizeof(sines) / sizeof(double),
        .evaluate = evaluate,
        .series = &zd_four_bar_series,
        .closed_form = zd_four_bar_closed_form, .closed_forms = ZD_COUNT_OF_SETS,
        .embed = embed,
        .independent = (const int[]){ALPHA_1},
    },
    ZD_PREPARED(ZD_FOUR_BAR_CLOSED_FORM_ENDS),
    .coordinate = coordinate, .velocity = velocity, .constraint = constraint,
    .points = N + 1, .dimension = 2, .draw = draw,
    .precise = &zd_four_bar_precise,
};
