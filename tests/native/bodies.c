/* Rods in the plane and the pins between them, in the absolute coordinates x, y, angle of each: the same equations with packed matrices
 * and with dense ones.
 *
 * data: how many rods and pins, g, the speed of the first pin along x; of each rod mass and moment of inertia; of each pin the rods a < b
 * that it joins, a = -1 being the ground, and where it is in the frame of each, or on the ground. The first pin may be on the ground only.
 */
#include <math.h>
#include <string.h>
#include <zerodrift/sines.h>
#include <zerodrift/system.h>

const int zd_interface_version = ZD_INTERFACE_VERSION;

typedef struct pin {
    int a, b;
    double at[4];
} pin;

static pin pin_at(const double *q, int rods, int k)
{
    const double *of = q + 4 + 2 * rods + 6 * k;
    return (pin){(int)of[0], (int)of[1], {of[2], of[3], of[4], of[5]}};
}

/* The way from the centre of the rod that has this sine and cosine to a point (x, y) of it */
static void write_arm(double sine, double cosine, const double *point, double *to)
{
    to[0] = cosine * point[0] - sine * point[1];
    to[1] = sine * point[0] + cosine * point[1];
}

/* Kept in the scratch while p stays: the angles of all rods, their sines and their cosines, and behind them for each pin the ways to it from
 * the centres of both rods; on the ground, where it is. */
static void turn(const double *q, const double *p, double *turned)
{
    int rods = (int)q[0], pins = (int)q[1];
    double *sine = turned + rods, *cosine = sine + rods, *arms = cosine + rods;
    for (int b = 0; b < rods; b++) turned[b] = p[3 * b + 2];
    zd_sines(rods, turned, sine, cosine);
    for (int k = 0; k < pins; k++, arms += 4) {
        pin at = pin_at(q, rods, k);
        if (at.a >= 0) write_arm(sine[at.a], cosine[at.a], at.at, arms);
        else memcpy(arms, at.at, 2 * sizeof *arms);
        write_arm(sine[at.b], cosine[at.b], at.at + 2, arms + 2);
    }
}

/* sign times the rows of a point of a rod, whose columns begin at C, rows `width` apart */
static void write_rows(double *C, int width, double sign, const double *r)
{
    C[0] = C[width + 1] = sign;
    C[1] = C[width] = 0;
    C[2] = -sign * r[1];
    C[width + 2] = sign * r[0];
}

static void write_C(const double *q, int dense, const double *turned, double *C)
{
    int rods = (int)q[0], pins = (int)q[1], n = 3 * rods;
    const double *arms = turned + 3 * rods;
    if (dense) memset(C, 0, (size_t)(2 * pins * n) * sizeof *C);
    for (int k = 0; k < pins; k++, arms += 4) {
        pin at = pin_at(q, rods, k);
        int width = dense ? n : at.a < 0 ? 3 : 6;
        write_rows(C + (dense ? 3 * at.b : width - 3), width, 1, arms + 2);
        if (at.a >= 0) write_rows(C + (dense ? 3 * at.a : 0), width, -1, arms);
        C += 2 * width;
    }
}

static void write_M(const double *q, int dense, double *M)
{
    int rods = (int)q[0], n = 3 * rods;
    if (dense) memset(M, 0, (size_t)(n * n) * sizeof *M);
    for (int b = 0; b < rods; b++)
        for (int i = 0; i < 3; i++) M[(3 * b + i) * (dense ? n + 1 : 1)] = q[4 + 2 * b + (i == 2)];
}

/* Of a rod, three of x; of the ground, zeros */
static const double *own(const double *x, int rod)
{
    static const double ground[3];
    return rod < 0 ? ground : x + 3 * rod;
}

static void write_Phi(const double *q, double t, const double *turned, const double *p, double *Phi)
{
    int rods = (int)q[0], pins = (int)q[1];
    const double *arms = turned + 3 * rods;
    double moved = q[3] * t;
    for (int k = 0; k < pins; k++, arms += 4, moved = 0) {
        pin at = pin_at(q, rods, k);
        const double *a = own(p, at.a), *b = own(p, at.b);
        double x = b[0] + arms[2] - (arms[0] + moved) - a[0], y = b[1] + arms[3] - arms[1] - a[1];
        Phi[2 * k] = x;
        Phi[2 * k + 1] = y;
    }
}

static void write_xi(const double *q, const double *turned, const double *v, double *xi)
{
    int rods = (int)q[0], pins = (int)q[1];
    const double *arms = turned + 3 * rods;
    for (int k = 0; k < pins; k++, arms += 4) {
        pin at = pin_at(q, rods, k);
        double wa = own(v, at.a)[2], wb = own(v, at.b)[2];
        double x = wb * wb * arms[2] - wa * wa * arms[0], y = wb * wb * arms[3] - wa * wa * arms[1];
        xi[2 * k] = x;
        xi[2 * k + 1] = y;
    }
}

static void write_f(const double *q, double *f)
{
    int rods = (int)q[0];
    double g = q[2];
    for (int b = 0; b < rods; b++, f += 3) f[0] = f[2] = 0, f[1] = -q[4 + 2 * b] * g;
}

static double potential(const double *q, const double *p)
{
    double V = 0;
    for (int b = 0; b < (int)q[0]; b++) V += q[4 + 2 * b] * q[2] * p[3 * b + 1];
    return V;
}

static int evaluate(int dense, const double *q, int want, double t, const double *p, const double *v, const zd_terms *out)
{
    int pins = (int)q[1];
    if (want & ZD_MOVED) turn(q, p, out->scratch);
    if (want & ZD_M) write_M(q, dense, out->M);
    if (want & ZD_C) write_C(q, dense, out->scratch, out->C);
    if (want & ZD_FORCE) write_f(q, out->f);
    if (want & ZD_POTENTIAL) *out->V = potential(q, p);
    if (want & ZD_PHI) write_Phi(q, t, out->scratch, p, out->Phi);
    if (want & ZD_XI) write_xi(q, out->scratch, v, out->xi);
    for (int i = 0; i < 2 * pins && (want & ZD_PHI_T); i++) out->Phi_t[i] = i ? 0 : -q[3];
    return ZD_DONE;
}

int packed(const void *data, int want, double t, const double *p, const double *v, const zd_terms *out)
{
    return evaluate(0, data, want, t, p, v, out);
}

int dense(const void *data, int want, double t, const double *p, const double *v, const zd_terms *out)
{
    return evaluate(1, data, want, t, p, v, out);
}

/* ---- two rods that hang on the ground, as a kind ---- */

static const char *prepare(const double *parameters, double *constants)
{
    const double fixed[] = {2, 2, parameters[0], 0, 1, 1. / 12, 1, 1. / 12, -1, 0, 0, 0, -.5, 0, 0, 1, .5, 0, -.5, 0};
    memcpy(constants, fixed, sizeof fixed);
    return NULL;
}

static void start(const double *parameters, double *p, double *v)
{
    const double at[] = {.5, 0, 0, 1.5, 0, 0};
    (void)parameters;
    memcpy(p, at, sizeof at);
    memset(v, 0, sizeof at);
}

static const double earth[] = {9.81};
static const zd_parameter parameter[] = {{"gravity", "m/s^2", "", 1, ZD_ANY, earth}};
static const zd_variable coordinate[] = {{"x1", "m"}, {"y1", "m"}, {"a1", "rad"}, {"x2", "m"}, {"y2", "m"}, {"a2", "rad"}};
static const zd_variable velocity[] = {{"vx1", "m/s"}, {"vy1", "m/s"}, {"w1", "rad/s"}, {"vx2", "m/s"}, {"vy2", "m/s"}, {"w2", "rad/s"}};
static const zd_variable constraint[] = {{"ground x", "m"}, {"ground y", "m"}, {"pin x", "m"}, {"pin y", "m"}};
static const int three[] = {3, 3}, mass[] = {ZD_CONSTANT | ZD_DIAGONAL, ZD_CONSTANT | ZD_DIAGONAL}, two[] = {2, 2};
static const int first[] = {0, 1, 3}, touched[] = {0, 0, 1};
static const zd_structure structure = {
    .blocks = 2, .coordinates = three, .velocities = three, .mass = mass, .groups = 2, .rows = two, .first = first, .block = touched,
};

/* The same with products of their own, which are counted. */
static int products;

int count_products(void) { return products; }

static void times_C(const void *data, const zd_terms *terms, const double *x, double *y)
{
    const double *C = terms->C;
    (void)data;
    products++;
    for (int k = 0; k < 2; k++, C += 3) y[k] = C[0] * x[0] + C[1] * x[1] + C[2] * x[2];
    for (int k = 2; k < 4; k++, C += 6) {
        y[k] = 0;
        for (int i = 0; i < 6; i++) y[k] += C[i] * x[i];
    }
}

static void times_M(const void *data, const zd_terms *terms, const double *x, double *y)
{
    (void)data;
    products++;
    for (int i = 0; i < 6; i++) y[i] = terms->M[i] * x[i];
}

static const zd_operations operations = {.times_C = times_C, .times_M = times_M};

const zd_kind zd_kind_two_rods_with_products = {
    .card = {.name = "two_rods_with_products", .summary = "Two rods.", .equations = ""},
    .system = {
        .nq = 6, .nv = 6, .mh = 4, .scratch = 14,
        .provides = ZD_M | ZD_FORCE | ZD_PHI | ZD_C | ZD_XI | ZD_POTENTIAL,
        .evaluate = packed,
        .structure = &structure,
        .operations = &operations,
    },
    .parameters = 1, .constants = 20,
    .parameter = parameter, .coordinate = coordinate, .velocity = velocity, .constraint = constraint,
    .prepare = prepare, .start = start,
};

const zd_kind zd_kind_two_rods = {
    .card = {.name = "two_rods", .summary = "Two rods.", .equations = ""},
    .system = {
        .nq = 6, .nv = 6, .mh = 4, .scratch = 14,
        .provides = ZD_M | ZD_FORCE | ZD_PHI | ZD_C | ZD_XI | ZD_POTENTIAL,
        .evaluate = packed,
        .structure = &structure,
    },
    .parameters = 1, .constants = 20,
    .parameter = parameter, .coordinate = coordinate, .velocity = velocity, .constraint = constraint,
    .prepare = prepare, .start = start,
};
