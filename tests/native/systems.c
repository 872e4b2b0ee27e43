/* Systems of several tests as a user would write them: constraints that move in time, a unit quaternion, and a holonomic
 * constraint beside a nonholonomic one. */
#include <math.h>
#include <string.h>
#include <zerodrift/system.h>

const int zd_interface_version = ZD_INTERFACE_VERSION;

#define ROW(to, ...) memcpy(to, ((const double[]){__VA_ARGS__}), sizeof((const double[]){__VA_ARGS__}))
#define NUMBER(name, rule, value) {name, "", "", 1, rule, (const double[]){value}}
#define NUMBERS 4

static const char *prepare(const double *parameters, double *constants)
{
    memcpy(constants, parameters, NUMBERS * sizeof *constants);
    return NULL;
}

static void diagonal(int n, const double *masses, double *M)
{
    memset(M, 0, (size_t)(n * n) * sizeof *M);
    for (int i = 0; i < n; i++) M[i * n + i] = masses[i];
}

/* ---- a particle at the end of an arm, whose angle is prescribed as rate t + amplitude sin(frequency t) ---- */

static int arm(const void *data, int want, double t, const double *p, const double *v, const zd_terms *out)
{
    const double *q = data, L = q[0], rate = q[1], amplitude = q[2], w = q[3];
    double s = sin(p[2]), c = cos(p[2]), spin = v[2] * v[2];
    if (want & ZD_M) diagonal(3, (const double[]){2, 2, 0.5}, out->M);
    if (want & ZD_FORCE) ROW(out->f, 0, -2 * 9.81, 0);
    if (want & ZD_PHI) ROW(out->Phi, p[0] - L * c, p[1] - L * s, p[2] - rate * t - amplitude * sin(w * t));
    if (want & ZD_C) ROW(out->C, 1, 0, L * s, 0, 1, -L * c, 0, 0, 1);
    if (want & ZD_PHI_T) ROW(out->Phi_t, 0, 0, -rate - amplitude * w * cos(w * t));
    if (want & ZD_XI) ROW(out->xi, -L * spin * c, -L * spin * s, -amplitude * w * w * sin(w * t));
    if (want & ZD_POTENTIAL) *out->V = 2 * 9.81 * p[1];
    return ZD_DONE;
}

static void arm_start(const double *q, double *p, double *v)
{
    double spin = q[1] + q[2] * q[3];
    ROW(p, q[0], 0, 0);
    ROW(v, 0, q[0] * spin, spin);
}

static void arm_draw(const double *q, const double *p, double *points)
{
    (void)q;
    ROW(points, 0, 0, p[0], p[1]);
}

/* ---- a heavy top: its axis of symmetry is its second, about a point of which it turns; angular velocity along its own axes ---- */

static void turn(const double *p, const double *a, double *to)      /* to <- a (3,) of the body, in the room */
{
    double w = p[3], x = p[4], y = p[5], z = p[6];
    to[0] = (1 - 2 * (y * y + z * z)) * a[0] + 2 * (x * y - w * z) * a[1] + 2 * (x * z + w * y) * a[2];
    to[1] = 2 * (x * y + w * z) * a[0] + (1 - 2 * (x * x + z * z)) * a[1] + 2 * (y * z - w * x) * a[2];
    to[2] = 2 * (x * z - w * y) * a[0] + 2 * (y * z + w * x) * a[1] + (1 - 2 * (x * x + y * y)) * a[2];
}

static void top_kinematics(const double *e, double *A)
{
    const double half[4][3] = {{-e[1], -e[2], -e[3]}, {e[0], -e[3], e[2]}, {e[3], e[0], -e[1]}, {-e[2], e[1], e[0]}};
    memset(A, 0, 42 * sizeof *A);
    for (int i = 0; i < 3; i++) A[7 * i] = 1;
    for (int i = 0; i < 12; i++) A[18 + 6 * (i / 3) + 3 + i % 3] = half[i / 3][i % 3] / 2;
}

static int top(const void *data, int want, double t, const double *p, const double *v, const zd_terms *out)
{
    const double *q = data, m = q[0], L = q[1], a = q[2], b = q[3], *w = v + 3;
    double axis[3][3];
    const double centripetal[] = {L * w[0] * w[1], -L * (w[0] * w[0] + w[2] * w[2]), L * w[1] * w[2]};
    (void)t;
    for (int k = 0; k < 3; k++) turn(p, (const double[]){k == 0, k == 1, k == 2}, axis[k]);
    if (want & ZD_A) top_kinematics(p + 3, out->A);
    if (want & ZD_M) diagonal(6, (const double[]){m, m, m, a, b, a}, out->M);
    if (want & ZD_BIAS) ROW(out->d, 0, 0, 0, (a - b) * w[1] * w[2], 0, (b - a) * w[0] * w[1]);
    if (want & ZD_FORCE) ROW(out->f, 0, 0, -m * 9.81, 0, 0, 0);
    for (int i = 0; i < 3; i++) {
        if (want & ZD_PHI) out->Phi[i] = p[i] - L * axis[1][i];
        if (want & ZD_C) ROW(out->C + 6 * i, i == 0, i == 1, i == 2, -L * axis[2][i], 0, L * axis[0][i]);
    }
    if (want & ZD_XI) turn(p, centripetal, out->xi);
    if (want & ZD_POTENTIAL) *out->V = m * 9.81 * p[2];
    return ZD_DONE;
}

static void top_start(const double *q, double *p, double *v)
{
    const double w = -4.61538;
    ROW(p, 0, q[1], 0, 1, 0, 0, 0);
    ROW(v, -q[1] * w, 0, 0, 0, 150, w);
}

/* ---- a skate in a bowl z = k (x^2 + y^2) / 2, with speeds along and across the edge; it has no equations beyond the rim ---- */

static int skate(const void *data, int want, double t, const double *p, const double *v, const zd_terms *out)
{
    const double *q = data, m = q[0], J = q[1], k = q[2], rim = q[3], s = sin(p[3]), c = cos(p[3]), x = p[0], y = p[1];
    double along = (x * c + y * s) / 2, across = (y * c - x * s) / 2;      /* of the centre */
    (void)t;
    if (hypot(x, y) > rim) return ZD_NOT_FINITE;
    if (want & ZD_A) ROW(out->A, c, -s, 0, 0, s, c, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1);
    if (want & ZD_M) diagonal(4, (const double[]){m, m, m, J}, out->M);
    if (want & ZD_BIAS) ROW(out->d, -m * v[1] * v[3], m * v[0] * v[3], 0, 0);
    if (want & ZD_FORCE) ROW(out->f, 0, 0, -m * 9.81, 0);
    if (want & ZD_PHI) *out->Phi = p[2] / (2 * k) - (x * x + y * y) / 4;
    if (want & ZD_C) ROW(out->C, -along, -across, 1 / (2 * k), 0, 0, 1, 0, 0);
    if (want & ZD_XI) ROW(out->xi, (v[0] / 2 + across * v[3]) * v[0] + (v[1] / 2 - along * v[3]) * v[1], 0);
    if (want & ZD_POTENTIAL) *out->V = m * 9.81 * p[2];
    return ZD_DONE;
}

static void skate_start(const double *q, double *p, double *v)
{
    ROW(p, 0.8, 0.1, q[2] * 0.325, 0.3);
    ROW(v, 0.4, 0, 0.4 * q[2] * (0.8 * cos(0.3) + 0.1 * sin(0.3)), 1);
}

/* ---- as kinds ---- */

#define KIND(kind, text, ...) const zd_kind zd_kind_##kind = { \
    .card = {.name = #kind, .summary = text, .equations = ""}, \
    .parameters = NUMBERS, .constants = NUMBERS, .parameter = kind##_parameter, .coordinate = kind##_coordinate, \
    .velocity = kind##_velocity, .constraint = kind##_constraint, .prepare = prepare, .start = kind##_start, __VA_ARGS__}

static const zd_parameter arm_parameter[] = {NUMBER("length", ZD_POSITIVE, 1), NUMBER("rate", ZD_ANY, 2),
                                             NUMBER("amplitude", ZD_ANY, 1), NUMBER("frequency", ZD_ANY, 5)};
static const zd_variable arm_coordinate[] = {{"x", "m"}, {"y", "m"}, {"angle", "rad"}};
static const zd_variable arm_velocity[] = {{"x_dot", "m/s"}, {"y_dot", "m/s"}, {"spin", "rad/s"}};
static const zd_variable arm_constraint[] = {{"arm x", "m"}, {"arm y", "m"}, {"drive", "rad"}};
KIND(arm, "Driven arm.", .points = 2, .dimension = 2, .draw = arm_draw, .system = {
    .nq = 3, .nv = 3, .mh = 3, .evaluate = arm,
    .provides = ZD_M | ZD_FORCE | ZD_PHI | ZD_C | ZD_PHI_T | ZD_XI | ZD_POTENTIAL});

static const zd_parameter top_parameter[] = {NUMBER("mass", ZD_POSITIVE, 15), NUMBER("arm", ZD_POSITIVE, 1),
                                             NUMBER("diameter_inertia", ZD_POSITIVE, 0.234375),
                                             NUMBER("axial_inertia", ZD_POSITIVE, 0.46875)};
static const zd_variable top_coordinate[] = {{"x", "m"}, {"y", "m"}, {"z", "m"},
                                             {"e0", ""}, {"e1", ""}, {"e2", ""}, {"e3", ""}};
static const zd_variable top_velocity[] = {{"vx", "m/s"}, {"vy", "m/s"}, {"vz", "m/s"},
                                           {"w1", "rad/s"}, {"w2", "rad/s"}, {"w3", "rad/s"}};
static const zd_variable top_constraint[] = {{"point x", "m"}, {"point y", "m"}, {"point z", "m"}};
KIND(top, "Heavy top.", .system = {
    .nq = 7, .nv = 6, .mh = 3, .evaluate = top, .quaternions = 1, .quaternion = (const int[]){3},
    .provides = ZD_A | ZD_M | ZD_BIAS | ZD_FORCE | ZD_PHI | ZD_C | ZD_XI | ZD_POTENTIAL | ZD_TIMELESS});

static const zd_parameter skate_parameter[] = {NUMBER("mass", ZD_POSITIVE, 1.5), NUMBER("inertia", ZD_POSITIVE, 0.2),
                                               NUMBER("curvature", ZD_ANY, 6), NUMBER("rim", ZD_POSITIVE, 100)};
static const zd_variable skate_coordinate[] = {{"x", "m"}, {"y", "m"}, {"z", "m"}, {"heading", "rad"}};
static const zd_variable skate_velocity[] = {{"along", "m/s"}, {"across", "m/s"}, {"vz", "m/s"}, {"turning", "rad/s"}};
static const zd_variable skate_constraint[] = {{"bowl", "m"}, {"edge", "m/s"}};
KIND(skate, "Skate in a bowl.", .system = {
    .nq = 4, .nv = 4, .mh = 1, .mn = 1, .evaluate = skate, .failure = "the skate is beyond the rim",
    .provides = ZD_A | ZD_M | ZD_BIAS | ZD_FORCE | ZD_PHI | ZD_C | ZD_XI | ZD_POTENTIAL | ZD_TIMELESS});
