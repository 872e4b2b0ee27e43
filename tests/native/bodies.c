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

/* The angles of all rods, their sines and their cosines, which are kept in the scratch while p stays. */
static void turn(int rods, const double *p, double *turned)
{
    for (int b = 0; b < rods; b++) turned[b] = p[3 * b + 2];
    zd_sines(rods, turned, turned + rods, turned + 2 * rods);
}

/* Where a point (x, y) of a rod is, from the rod's centre */
static void arm(const double *turned, int rods, int rod, const double *point, double *to)
{
    double s = turned[rods + rod], c = turned[2 * rods + rod];
    to[0] = c * point[0] - s * point[1];
    to[1] = s * point[0] + c * point[1];
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
    if (dense) memset(C, 0, (size_t)(2 * pins * n) * sizeof *C);
    for (int k = 0; k < pins; k++) {
        pin at = pin_at(q, rods, k);
        int width = dense ? n : at.a < 0 ? 3 : 6;
        double r[2];
        arm(turned, rods, at.b, at.at + 2, r);
        write_rows(C + (dense ? 3 * at.b : width - 3), width, 1, r);
        if (at.a >= 0) {
            arm(turned, rods, at.a, at.at, r);
            write_rows(C + (dense ? 3 * at.a : 0), width, -1, r);
        }
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

/* Phi and xi of one pin */
static void write_pin(const double *q, int k, double t, const double *turned, const double *p, const double *v, double *Phi, double *xi)
{
    int rods = (int)q[0];
    pin at = pin_at(q, rods, k);
    double r[2], s[2] = {at.at[0] + (k ? 0 : q[3] * t), at.at[1]};
    arm(turned, rods, at.b, at.at + 2, r);
    if (at.a >= 0) arm(turned, rods, at.a, at.at, s);
    for (int i = 0; i < 2; i++) {
        double wa = at.a < 0 ? 0 : v[3 * at.a + 2], wb = v[3 * at.b + 2];
        Phi[i] = p[3 * at.b + i] + r[i] - s[i] - (at.a < 0 ? 0 : p[3 * at.a + i]);
        xi[i] = wb * wb * r[i] - wa * wa * s[i];
    }
}

static int evaluate(int dense, const double *q, int want, double t, const double *p, const double *v, const zd_terms *out)
{
    int rods = (int)q[0], pins = (int)q[1];
    if (want & ZD_MOVED) turn(rods, p, out->scratch);
    if (want & ZD_M) write_M(q, dense, out->M);
    if (want & ZD_C) write_C(q, dense, out->scratch, out->C);
    if (want & ZD_POTENTIAL) *out->V = 0;
    for (int b = 0; b < rods; b++) {
        double mass = q[4 + 2 * b];
        if (want & ZD_FORCE) out->f[3 * b] = out->f[3 * b + 2] = 0, out->f[3 * b + 1] = -mass * q[2];
        if (want & ZD_POTENTIAL) *out->V += mass * q[2] * p[3 * b + 1];
    }
    for (int k = 0; k < pins && (want & (ZD_PHI | ZD_XI | ZD_PHI_T)); k++) {
        double Phi[2], xi[2];
        write_pin(q, k, t, out->scratch, p, v, Phi, xi);
        for (int i = 0; i < 2; i++) {
            if (want & ZD_PHI) out->Phi[2 * k + i] = Phi[i];
            if (want & ZD_XI) out->xi[2 * k + i] = xi[i];
            if (want & ZD_PHI_T) out->Phi_t[2 * k + i] = k || i ? 0 : -q[3];
        }
    }
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
        .nq = 6, .nv = 6, .mh = 4, .scratch = 6,
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
        .nq = 6, .nv = 6, .mh = 4, .scratch = 6,
        .provides = ZD_M | ZD_FORCE | ZD_PHI | ZD_C | ZD_XI | ZD_POTENTIAL,
        .evaluate = packed,
        .structure = &structure,
    },
    .parameters = 1, .constants = 20,
    .parameter = parameter, .coordinate = coordinate, .velocity = velocity, .constraint = constraint,
    .prepare = prepare, .start = start,
};
