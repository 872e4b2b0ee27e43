/* A pendulum as a user of the installed package would write it: a function, and the same described by the library itself. */
#include <stddef.h>
#include <math.h>
#include <zerodrift/system.h>

const int zd_interface_version = ZD_INTERFACE_VERSION;

/* data: mass, gravity, length */
int pendulum(const void *data, int want, double t, const double *p, const double *v, const zd_terms *out)
{
    const double *q = data, m = q[0], g = q[1], L = q[2], x = p[0], y = p[1];
    (void)t;
    if (want & ZD_M) {
        out->M[0] = out->M[3] = m;
        out->M[1] = out->M[2] = 0;
    }
    if (want & ZD_FORCE) {
        out->f[0] = 0;
        out->f[1] = -m * g;
    }
    if (want & ZD_PHI) out->Phi[0] = (x * x + y * y - L * L) / (2 * L);
    if (want & ZD_C) {
        out->C[0] = x / L;
        out->C[1] = y / L;
    }
    if (want & ZD_XI) out->xi[0] = -(v[0] * v[0] + v[1] * v[1]) / L;
    if (want & ZD_POTENTIAL) out->V[0] = m * g * y;
    return ZD_DONE;
}

static const char *prepare(const double *parameters, double *constants)
{
    for (int i = 0; i < 3; i++) constants[i] = parameters[i];
    return parameters[1] > 100 ? "gravity must be at most 100 m/s^2" : NULL;
}

static void start(const double *parameters, double *p, double *v)
{
    p[0] = parameters[2];
    p[1] = v[0] = v[1] = 0;
}

static void draw(const double *constants, const double *p, double *points)
{
    (void)constants;
    points[0] = points[1] = 0;
    points[2] = p[0];
    points[3] = p[1];
}

static const double one[] = {1}, earth[] = {9.81};
static const zd_parameter parameter[] = {
    {"mass", "kg", "", 1, ZD_POSITIVE, one},
    {"gravity", "m/s^2", "", 1, ZD_ANY, earth},
    {"length", "m", "", 1, ZD_POSITIVE, one},
};
static const zd_variable coordinate[] = {{"x", "m"}, {"y", "m"}}, velocity[] = {{"x_dot", "m/s"}, {"y_dot", "m/s"}};
static const zd_variable constraint[] = {{"rod", "m"}};

const zd_kind zd_kind_pendulum = {
    .card = {"pendulum", "Point mass on a rod.", "", 0, 0},
    .system = {
        .nq = 2, .nv = 2, .mh = 1,
        .provides = ZD_M | ZD_FORCE | ZD_PHI | ZD_C | ZD_XI | ZD_POTENTIAL,
        .evaluate = pendulum,
    },
    .parameters = 3, .constants = 3,
    .parameter = parameter, .coordinate = coordinate, .velocity = velocity, .constraint = constraint,
    .prepare = prepare, .start = start,
    .points = 2, .dimension = 2, .draw = draw,
};
const zd_kind zd_kind_without_a_start = {
    .card = {"pendulum", "", "", 0, 0},
    .system = {.nq = 2, .nv = 2, .provides = ZD_M, .evaluate = pendulum},
    .constants = 3, .coordinate = coordinate, .velocity = velocity, .prepare = prepare,
};

/* ---- mistakes ---- */

int beyond_its_force(const void *data, int want, double t, const double *p, const double *v, const zd_terms *out)
{
    if (want & ZD_FORCE) out->f[2] = 0;
    return pendulum(data, want, t, p, v, out);
}

int deaf(const void *data, int want, double t, const double *p, const double *v, const zd_terms *out)
{
    out->power[0] = 0;      /* whether it is wanted or not */
    return pendulum(data, want, t, p, v, out);
}

/* data: and a time from which on a term, numbered as the pointers to them are, is not finite, or if 12, the evaluation fails */
int spoilt(const void *data, int want, double t, const double *p, const double *v, const zd_terms *out)
{
    const double *q = data;
    double *const *terms = (double *const *)out;
    int term = (int)q[4], status = pendulum(data, want, t, p, v, out);
    if (want & ZD_A) {
        out->A[0] = out->A[3] = 1;
        out->A[1] = out->A[2] = 0;
    }
    if (want & ZD_BIAS) out->d[0] = out->d[1] = 0;
    if (want & ZD_PHI_T) out->Phi_t[0] = 0;
    if (want & ZD_POWER) out->power[0] = 0;
    if (t < q[3]) return status;
    if (term == 12) return 1;
    if (want & (1 << term)) *terms[term] = NAN;
    return status;
}
