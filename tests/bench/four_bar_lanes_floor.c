/* What a corrected RK4 step of the paper's four-bar costs by hand where LANES runs go side by side in a vector: the yardstick of
 * bench_lanes.py.
 *
 *     cc -O3 -std=gnu11 -march=native -mprefer-vector-width=512 -DLANES=8 -shared -fPIC -o floor.so four_bar_lanes_floor.c
 *
 * With the crank's angle independent, C x = r is x = x0 + D a with D = (1, d2, d3), and M-orthogonal corrections have D^T M x = 0. With
 * -DSCHUR, M and S = C M^-1 C^T are factored instead, as for a mechanism of which nothing is known but M and C. Nothing is
 * looked at: no pivots, no safeguards, no rows; all runs make as many steps.
 */
#include <math.h>
#include <stddef.h>
#include <stdint.h>

typedef double real __attribute__((vector_size(8 * LANES)));
typedef int64_t word __attribute__((vector_size(8 * LANES)));

static const double L1 = 0.3, L2 = 1.0, L3 = 0.6, L4 = 1.0, TOLERANCE = 1e-12;
static const double M11 = 0.765, M22 = 14.0 / 3, M33 = 0.36, K12 = 1.65, K13 = 0.27, K23 = 0.9;
static const double W1 = 25.75125, W2 = 53.955, W3 = 8.829;     /* N m: of the weights, at level links */

/* Fdlibm's kernels, behind a reduction by half turns' halves in three parts; |x| below some thousands */
static inline void turn(real x, real *sine, real *cosine)
{
    const real k = x * 0.6366197723675814 + 0x1.8p52, n = k - 0x1.8p52;
    const word q = (word)k;
    const real r = x - n * 0x1.921fb54400000p0 - n * 0x1.0b4611a600000p-34 - n * 0x1.3198a2e037073p-69, z = r * r;
    const real s = r + r * z * (-1.66666666666666324348e-01 + z * (8.33333333332248946124e-03 + z * (-1.98412698298579493134e-04
                 + z * (2.75573137070700676789e-06 + z * (-2.50507602534068634195e-08 + z * 1.58969099521155010221e-10)))));
    const real c = 1 - z * 0.5 + z * z * (4.16666666666666019037e-02 + z * (-1.38888888888741095749e-03 + z * (2.48015872894767294178e-05
                 + z * (-2.75573143513906633035e-07 + z * (2.08757232129817482790e-09 + z * -1.13596475577881948265e-11)))));
    const word odd = -(q & 1), change = ((word)s ^ (word)c) & odd;
    *sine = (real)(((word)s ^ change) ^ ((q & 2) << 62));
    *cosine = (real)(((word)c ^ change) ^ (((q + 1) & 2) << 62));
}

#ifdef SCHUR
/* M = L D L^T with 1 / D in d, C in b and e, which become L^-1 C^T; z and w are these over D, S = K G K^T with 1 / G in g and K in k */
typedef struct { real s[3], c[3], m12, m13, m23, l12, l13, l23, d[3], z[3], w[3], k, g[2]; } pose;

static inline void look(const real *p, pose *a)
{
    for (int i = 0; i < 3; i++) turn(p[i], &a->s[i], &a->c[i]);
}

static double diagonal[3];      /* of M; not const, so that the compiler cannot fold it */

static inline void forward(const pose *a, real *x)
{
    x[1] -= a->l12 * x[0];
    x[2] -= a->l13 * x[0] + a->l23 * x[1];
}

static inline void backward(const pose *a, real *x)
{
    x[1] -= a->l23 * x[2];
    x[0] -= a->l12 * x[1] + a->l13 * x[2];
}

static inline real times(const real *x, const real *y)
{
    return x[0] * y[0] + x[1] * y[1] + x[2] * y[2];
}

static inline void eliminate(pose *a)
{
    const real *s = a->s, *c = a->c, one = 1 + (s[0] - s[0]);
    a->m12 = K12 * (c[0] * c[1] + s[0] * s[1]);
    a->m13 = K13 * (c[0] * c[2] + s[0] * s[2]);
    a->m23 = K23 * (c[1] * c[2] + s[1] * s[2]);
    a->d[0] = one / diagonal[0];
    a->l12 = a->m12 * a->d[0];
    a->l13 = a->m13 * a->d[0];
    a->d[1] = 1 / (diagonal[1] - a->l12 * a->m12);
    const real rest = a->m23 - a->l13 * a->m12;
    a->l23 = rest * a->d[1];
    a->d[2] = 1 / (diagonal[2] - a->l13 * a->m13 - a->l23 * rest);
    real b[3] = {-L1 * s[0], -L2 * s[1], -L3 * s[2]}, e[3] = {L1 * c[0], L2 * c[1], L3 * c[2]};
    forward(a, b);
    forward(a, e);
    for (int i = 0; i < 3; i++) a->z[i] = a->d[i] * b[i], a->w[i] = a->d[i] * e[i];
    const real both = times(b, a->w);
    a->g[0] = 1 / times(b, a->z);
    a->k = both * a->g[0];
    a->g[1] = 1 / (times(e, a->w) - a->k * both);
}

/* x with C x = (r1, r2), and M x = f - C^T lambda; f NULL: 0 */
static inline void solve(const pose *a, real r1, real r2, const real *f, real *x)
{
    real y[3];
    for (int i = 0; f && i < 3; i++) y[i] = f[i];
    if (f) forward(a, y);
    const real q1 = f ? times(a->z, y) - r1 : -r1, q2 = f ? times(a->w, y) - r2 : -r2;
    const real m2 = (q2 - a->k * q1) * a->g[1], m1 = q1 * a->g[0] - a->k * m2;
    for (int i = 0; i < 3; i++) x[i] = f ? a->d[i] * y[i] - a->z[i] * m1 - a->w[i] * m2 : -a->z[i] * m1 - a->w[i] * m2;
    backward(a, x);
}
#else
typedef struct { real s[3], c[3], m12, m13, m23, d2, d3, inverse, y1, y2, y3, mass; } pose;     /* y = M D, mass = 1 / D^T M D */

static inline void look(const real *p, pose *a)
{
    for (int i = 0; i < 3; i++) turn(p[i], &a->s[i], &a->c[i]);
}

static inline void eliminate(pose *a)
{
    const real *s = a->s, *c = a->c;
    const real det = L2 * L3 * (s[2] * c[1] - c[2] * s[1]), e2 = L1 * L3 * (s[0] * c[2] - c[0] * s[2]);
    const real e3 = L1 * L2 * (s[1] * c[0] - c[1] * s[0]);
    a->m12 = K12 * (c[0] * c[1] + s[0] * s[1]);
    a->m13 = K13 * (c[0] * c[2] + s[0] * s[2]);
    a->m23 = K23 * (c[1] * c[2] + s[1] * s[2]);
    const real z1 = M11 * det + a->m12 * e2 + a->m13 * e3, z2 = a->m12 * det + M22 * e2 + a->m23 * e3;
    const real z3 = a->m13 * det + a->m23 * e2 + M33 * e3;
    const real energy = z1 * det + z2 * e2 + z3 * e3, both = 1 / (det * energy);
    a->inverse = both * energy;
    a->d2 = e2 * a->inverse, a->d3 = e3 * a->inverse;
    a->mass = both * det * det * det;
    a->y2 = z2 * a->inverse, a->y3 = z3 * a->inverse;
}

/* x with C x = (r1, r2), and D^T M x = D^T f; f NULL: 0 */
static inline void solve(const pose *a, real r1, real r2, const real *f, real *x)
{
    const real force = f ? f[0] + a->d2 * f[1] + a->d3 * f[2] : r1 - r1;
    const real x2 = L3 * (a->c[2] * r1 + a->s[2] * r2) * a->inverse, x3 = -L2 * (a->c[1] * r1 + a->s[1] * r2) * a->inverse;
    x[0] = (force - a->y2 * x2 - a->y3 * x3) * a->mass;
    x[1] = x2 + a->d2 * x[0];
    x[2] = x3 + a->d3 * x[0];
}
#endif

static inline void accelerate(const real *p, const real *v, real *vdot)
{
    pose a;
    look(p, &a);
    eliminate(&a);
    const real *s = a.s, *c = a.c, w1 = v[0] * v[0], w2 = v[1] * v[1], w3 = v[2] * v[2];
    const real s12 = K12 * (s[1] * c[0] - c[1] * s[0]), s13 = K13 * (s[2] * c[0] - c[2] * s[0]), s23 = K23 * (s[2] * c[1] - c[2] * s[1]);
    const real f[3] = {s12 * w2 + s13 * w3 - W1 * c[0], s23 * w3 - s12 * w1 - W2 * c[1], -s13 * w1 - s23 * w2 - W3 * c[2]};
    solve(&a, L1 * c[0] * w1 + L2 * c[1] * w2 + L3 * c[2] * w3, L1 * s[0] * w1 + L2 * s[1] * w2 + L3 * s[2] * w3, f, vdot);
}

static inline int any(word open)
{
    int64_t found = 0;
    for (int i = 0; i < LANES; i++) found |= open[i];
    return found != 0;
}

static inline void correct(real *p, real *v)
{
    pose a;
    real x[3];
    for (int k = 0; k < 10; k++) {
        look(p, &a);
        const real r1 = L1 * a.c[0] + L2 * a.c[1] + L3 * a.c[2] - L4, r2 = L1 * a.s[0] + L2 * a.s[1] + L3 * a.s[2];
        const word open = (r1 > TOLERANCE) | (r1 < -TOLERANCE) | (r2 > TOLERANCE) | (r2 < -TOLERANCE);
        if (!any(open)) break;
        eliminate(&a);
        solve(&a, r1, r2, NULL, x);
        for (int i = 0; i < 3; i++) p[i] -= (real)((word)x[i] & open);
    }
    eliminate(&a);
    solve(&a, -(L1 * a.s[0] * v[0] + L2 * a.s[1] * v[1] + L3 * a.s[2] * v[2]),
          L1 * a.c[0] * v[0] + L2 * a.c[1] * v[1] + L3 * a.c[2] * v[2], NULL, x);
    for (int i = 0; i < 3; i++) v[i] -= x[i];
}

static inline void step(real *p, real *v, double h)
{
    real k[4][3], q[3], u[4][3];
    for (int i = 0; i < 3; i++) u[0][i] = v[i];
    accelerate(p, v, k[0]);
    for (int j = 1; j < 4; j++) {
        const double part = j == 3 ? h : h / 2;
        for (int i = 0; i < 3; i++) q[i] = p[i] + part * u[j - 1][i], u[j][i] = v[i] + part * k[j - 1][i];
        accelerate(q, u[j], k[j]);
    }
    for (int i = 0; i < 3; i++) {
        p[i] += h / 6 * (u[0][i] + 2 * (u[1][i] + u[2][i]) + u[3][i]);
        v[i] += h / 6 * (k[0][i] + 2 * (k[1][i] + k[2][i]) + k[3][i]);
    }
    correct(p, v);
}

/* So many groups of LANES runs, p and v (groups, 3, LANES) in place, each by so many steps */
void floor_in_lanes(int groups, int steps, double h, double *all_p, double *all_v)
{
#ifdef SCHUR
    diagonal[0] = M11, diagonal[1] = M22, diagonal[2] = M33;
#endif
    for (int g = 0; g < groups; g++) {
        real p[3], v[3];
        for (int i = 0; i < 3; i++)
            for (int lane = 0; lane < LANES; lane++)
                p[i][lane] = all_p[(3 * g + i) * LANES + lane], v[i][lane] = all_v[(3 * g + i) * LANES + lane];
        for (int k = 0; k < steps; k++) step(p, v, h);
        for (int i = 0; i < 3; i++)
            for (int lane = 0; lane < LANES; lane++)
                all_p[(3 * g + i) * LANES + lane] = p[i][lane], all_v[(3 * g + i) * LANES + lane] = v[i][lane];
    }
}
