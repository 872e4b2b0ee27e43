/* A thin disc, such as a coin, that rolls on a horizontal plane without slipping.
 *
 *           e3
 *         __|__             p = [x, y, z, yaw, lean, spin]: the centre, and the angles of the turns, in this order, about z,
 *       /   |   \           about e2 and about e1
 *      |    o----|--> e2    v = [vx, vy, vz, w1, w2, w3]: velocity of the centre, angular velocity along e1, e2, e3
 *       \       /
 *     ____-----____         e1 is the axle, towards the reader; e2 is horizontal; e3 points from the contact point to the
 *                           centre. This frame follows yaw and lean but not the spin.
 *
 * In that frame the inertia is constant, and as it turns with W = (-w3 tan lean, w2, w3) and not with w, Euler's equations are
 * I wdot + W x (I w) = moment. The contact point is at c = -R e3 from the centre:
 *
 *     z - R cos lean = 0,     v + w x c = 0 along x and along y.
 *
 * Since w x e3 = w2 e1 - w1 e2, the latter is v = R (w2 e1 - w1 e2). Neimark and Fufaev, Dynamics of Nonholonomic Systems, 1972;
 * Bloch, Nonholonomic Mechanics and Control, 2015, section 1.5.
 *
 * Where the disc lies flat, yaw and spin are the same turn: there, and only there, (1) is singular. It brings no closed-form functions, whose
 * pivots are those of C and M, which are regular there: a disc that swings through would not be noticed.
 */
#include <math.h>
#include <string.h>

#include "../include/zerodrift/sines.h"
#include "../include/zerodrift/system.h"
#include "disc.h"
#include "kind.h"
#include "precise/precise.h"
#include "series/series.h"

enum { X, Y, Z, YAW, LEAN, SPIN, N };
enum { VX, VY, VZ, W1, W2, W3 };
enum { HEIGHT, SLIP_X, SLIP_Y, ROWS };

static const double FLAT = 1e-8;    /* cos lean, below which the disc counts as flat */

/* parameters, in the order of the table at the end */
typedef struct given {
    double m, R, g;                 /* kg, m, m/s^2 */
    double Ia, It;                  /* kg m^2, about the axle and about a diameter */
    double lean, lean_rate, yaw_rate, spin_rate;
} given;

typedef struct constants {
    double m, R, weight, Ia, It;
} constants;

typedef struct sines {              /* sines and cosines of yaw and lean, valid while p does not change */
    double sy, cy, sl, cl;
} sines;

static sines sines_of(const double *p)
{
    const double angle[] = {p[YAW], p[LEAN]};
    double s[2], c[2];
    zd_sines(2, angle, s, c);
    return (sines){s[0], c[0], s[1], c[1]};
}

static void write_kinematics(const sines *a, double *A)
{
    memset(A, 0, N * N * sizeof *A);
    A[X * N + VX] = A[Y * N + VY] = A[Z * N + VZ] = 1;
    A[YAW * N + W3] = 1 / a->cl;
    A[LEAN * N + W2] = 1;
    A[SPIN * N + W1] = 1;
    A[SPIN * N + W3] = a->sl / a->cl;
}

static void write_mass(const constants *k, double *M)
{
    const double diagonal[N] = {k->m, k->m, k->m, k->Ia, k->It, k->It};
    memset(M, 0, N * N * sizeof *M);
    for (int i = 0; i < N; i++) M[i * N + i] = diagonal[i];
}

/* W x (I w) */
static void write_bias(const constants *k, const sines *a, const double *v, double *d)
{
    double moment = k->Ia * v[W1] + k->It * v[W3] * a->sl / a->cl;
    d[VX] = d[VY] = d[VZ] = d[W1] = 0;
    d[W2] = v[W3] * moment;
    d[W3] = -v[W2] * moment;
}

static void write_gradient(const constants *k, const sines *a, double *C)
{
    memset(C, 0, ROWS * N * sizeof *C);
    C[HEIGHT * N + VZ] = C[SLIP_X * N + VX] = C[SLIP_Y * N + VY] = 1;
    C[HEIGHT * N + W2] = k->R * a->sl;
    C[SLIP_X * N + W1] = -k->R * a->sy;
    C[SLIP_X * N + W2] = -k->R * a->cy * a->cl;
    C[SLIP_Y * N + W1] = k->R * a->cy;
    C[SLIP_Y * N + W2] = -k->R * a->sy * a->cl;
}

/* -Cdot v, with the rates w3 / cos lean of yaw and w2 of lean */
static void write_gradient_bias(const constants *k, const sines *a, const double *v, double *xi)
{
    double along = v[W3] / a->cl * v[W1] - v[W2] * v[W2] * a->sl, across = v[W3] * v[W2];
    xi[HEIGHT] = -k->R * a->cl * v[W2] * v[W2];
    xi[SLIP_X] = k->R * (along * a->cy - across * a->sy);
    xi[SLIP_Y] = k->R * (along * a->sy + across * a->cy);
}

static int evaluate(const void *data, int want, double t, const double *p, const double *v, const zd_terms *out)
{
    (void)t;
    const constants *k = data;
    sines *a = (sines *)out->scratch;
    if (want & ZD_MOVED) *a = sines_of(p);
    if (a->cl < FLAT) return ZD_NOT_FINITE;
    if (want & ZD_A) write_kinematics(a, out->A);                                               /* (1) */
    if (want & ZD_M) write_mass(k, out->M);
    if (want & ZD_BIAS) write_bias(k, a, v, out->d);
    if (want & ZD_FORCE) memcpy(out->f, (double[N]){[VZ] = -k->weight}, N * sizeof(double));
    if (want & ZD_PHI) out->Phi[HEIGHT] = p[Z] - k->R * a->cl;                                  /* (3) */
    if (want & ZD_C) write_gradient(k, a, out->C);                                              /* (5) */
    if (want & ZD_XI) write_gradient_bias(k, a, v, out->xi);                                    /* (6) */
    if (want & ZD_POTENTIAL) *out->V = k->weight * p[Z];
    return ZD_DONE;
}

static const char *prepare(const double *parameters, double *to)
{
    const given *q = (const given *)parameters;
    if (!(zd_cos(q->lean) > FLAT))
        return "lean must be between -pi/2 and pi/2: where the disc lies flat, yaw and spin are the same turn";
    double thin = q->m * q->R * q->R / 4;
    const constants k = {
        .m = q->m,
        .R = q->R,
        .weight = q->m * q->g,
        .Ia = isnan(q->Ia) ? 2 * thin : q->Ia,
        .It = isnan(q->It) ? thin : q->It,
    };
    memcpy(to, &k, sizeof k);
    return NULL;
}

/* Yaw and spin are 0 and the contact point is the origin, so that e1 = (cos lean, 0, -sin lean) and e2 = (0, 1, 0). */
static void start(const double *parameters, double *p, double *v)
{
    const given *q = (const given *)parameters;
    double s = zd_sin(q->lean), c = zd_cos(q->lean), w1 = q->spin_rate - q->yaw_rate * s;
    const double position[N] = {[X] = q->R * s, [Z] = q->R * c, [LEAN] = q->lean};
    const double velocity[N] = {
        q->R * q->lean_rate * c, -q->R * w1, -q->R * q->lean_rate * s,
        w1, q->lean_rate, q->yaw_rate * c,
    };
    memcpy(p, position, sizeof position);
    memcpy(v, velocity, sizeof velocity);
}

static void draw(const double *data, const double *p, double *points)
{
    const constants *k = (const constants *)data;
    const sines a = sines_of(p);
    const double e3[] = {a.cy * a.sl, a.sy * a.sl, a.cl}, ahead[] = {a.sy, -a.cy, 0};     /* -e2: the spin takes e3 there */
    zd_draw_disc(p, k->R, e3, ahead, p[SPIN], points);
}

static const double mass[] = {1}, radius[] = {0.5}, gravity[] = {9.81}, lean[] = {0.2}, zero[] = {0}, yawing[] = {0.4},
                    spinning[] = {6};

static const zd_parameter parameter[] = {
    {"mass", "kg", "", 1, ZD_POSITIVE, mass},
    {"radius", "m", "", 1, ZD_POSITIVE, radius},
    {"gravity", "m/s^2", "downwards, along -z", 1, ZD_ANY, gravity},
    {"axle_inertia", "kg m^2", "about the axle; left out: thin and uniform, m R^2 / 2", 1, ZD_POSITIVE, NULL},
    {"diameter_inertia", "kg m^2", "about a diameter; left out: thin and uniform, m R^2 / 4", 1, ZD_POSITIVE, NULL},
    {"lean", "rad", "from upright, between -pi/2 and pi/2, at the start", 1, ZD_ANY, lean},
    {"lean_rate", "rad/s", "at the start", 1, ZD_ANY, zero},
    {"yaw_rate", "rad/s", "about the vertical at the start", 1, ZD_ANY, yawing},
    {"spin_rate", "rad/s", "about the axle, beside what yaw adds, at the start", 1, ZD_ANY, spinning},
};

static const zd_variable coordinate[] = {{"x", "m"}, {"y", "m"}, {"z", "m"}, {"yaw", "rad"}, {"lean", "rad"}, {"spin", "rad"}};
static const zd_variable velocity[] = {{"vx", "m/s"},   {"vy", "m/s"},   {"vz", "m/s"},
                                       {"w1", "rad/s"}, {"w2", "rad/s"}, {"w3", "rad/s"}};
static const zd_variable constraint[] = {{"height", "m"}, {"slip_x", "m/s"}, {"slip_y", "m/s"}};

const zd_kind zd_rolling_disc = {
    .card = {
        .name = "rolling_disc",
        .summary = "Thin disc that rolls, leans and spins on a plane.",
        .equations = "Bloch, section 1.5",
        .description = "A thin disc, such as a coin, rolls on a horizontal plane without slipping. Its velocities are those of "
                       "the centre and the angular velocity in a frame that follows yaw and lean but not the spin, so that there "
                       "is a kinematic matrix. One holonomic constraint and two nonholonomic ones.",
        .reference = "A. M. Bloch, Nonholonomic Mechanics and Control, 2nd edition, Springer, 2015, section 1.5",
    },
    .system = {
        .nq = N, .nv = N, .mh = 1, .mn = 2,
        .provides = ZD_A | ZD_M | ZD_BIAS | ZD_FORCE | ZD_PHI | ZD_C | ZD_XI | ZD_POTENTIAL | ZD_TIMELESS,
        .scratch = sizeof(sines) / sizeof(double),
        .evaluate = evaluate,
        .series = &zd_rolling_disc_series,
        .failure = "the disc fell flat, where yaw and spin are the same turn; if it should have swung round, try a smaller step",
    },
    ZD_PREPARED(constants),
    .coordinate = coordinate, .velocity = velocity, .constraint = constraint,
    .points = ZD_DISC_POINTS, .dimension = 3, .draw = draw,
    .precise = &zd_rolling_disc_precise,
};
