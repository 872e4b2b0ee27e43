/* What a corrected step of the paper's four-bar costs where its constraints are eliminated by hand: a yardstick for the core, not a design.
 *
 * With three angles and two rows, the one free direction has a closed form, D = [1, D2, D3] of (14). Everything follows from it, without any
 * factorization: accelerations by (15) and D^T times (2), and both corrections (25) ... (27) in the metric of M.
 *
 * By default sines are the C library's; with -DPOLYNOMIAL_SINES they are polynomials for small angles, one beside the other. The coefficients
 * of DOP853 are in dop853_table.h, which bench_four_bar.py writes from SciPy's.
 */
#include "four_bar_floor.h"

#include <math.h>
#include <string.h>

#include "dop853_table.h"

enum { N = 3, STATE = 2 * N, LINK1 = 0, LINK2, LINK3, ITERATIONS = 10 };
#define INLINE static inline __attribute__((always_inline))

#define G 9.81
static const double l[N] = {0.3, 1.0, 0.6}, l0 = 1.0, m[N] = {1.5, 5.0, 3.0};

/* M and f of section 4.1 without their sines: diagonal, coefficients of cos(alpha_j - alpha_i), moments of the weights. The compiler
 * computes them. */
#define DIAGONAL1 (m[0] * l[0] * l[0] / 3 + (m[1] + m[2]) * l[0] * l[0])
#define DIAGONAL2 (m[1] * l[1] * l[1] / 3 + m[2] * l[1] * l[1])
#define DIAGONAL3 (m[2] * l[2] * l[2] / 3)
#define COUPLING12 ((m[1] / 2 + m[2]) * l[0] * l[1])
#define COUPLING13 (m[2] / 2 * l[0] * l[2])
#define COUPLING23 (m[2] / 2 * l[1] * l[2])
#define MOMENT1 ((m[0] / 2 + m[1] + m[2]) * l[0] * G)
#define MOMENT2 ((m[1] / 2 + m[2]) * l[1] * G)
#define MOMENT3 (m[2] / 2 * l[2] * G)

#ifdef POLYNOMIAL_SINES
/* In |r| <= pi/4, by Remez' algorithm; the quadrant is chosen without a branch. */
INLINE void turn(double angle, double *sine, double *cosine)
{
    double k = (angle * 0x1.45f306dc9c883p-1 + 0x1.8p52) - 0x1.8p52;
    double r = (angle - k * 0x1.921fb544p+0) - k * 0x1.0b4611a626331p-34, z = r * r;
    double S = ((-0x1.5555555555549p-3 + z * 0x1.111111110f87ap-7) + z * z * (-0x1.a01a019c11978p-13 + z * 0x1.71de3577b56b1p-19))
               + z * z * (z * z) * (-0x1.ae5e6639d428fp-26 + z * 0x1.5d9300cf18812p-33);
    double C = ((0x1.555555555554cp-5 + z * -0x1.6c16c16c1517ep-10) + z * z * (0x1.a01a019cb1bebp-16 + z * -0x1.27e4f809f15ecp-22))
               + z * z * (z * z) * (0x1.1ee9ebe9aae80p-29 + z * -0x1.8fae9cb4449ffp-37);
    double s = r + r * z * S, c = (1 - 0.5 * z) + z * z * C;
    long quadrant = (long)k;
    double a = quadrant & 1 ? c : s, b = quadrant & 1 ? s : c;
    *sine = quadrant & 2 ? -a : a;
    *cosine = (quadrant + 1) & 2 ? -b : b;
}
#else
INLINE void turn(double angle, double *sine, double *cosine)
{
    *sine = sin(angle);
    *cosine = cos(angle);
}
#endif

/* What depends on the angles alone. Differences such as s21 = sin(alpha_2 - alpha_1) are of the angles in brackets. */
typedef struct placed {
    double s[N], c[N];
    double s21, c21, s31, c31, s32, c32;
    double one_by_s32;
    double D2, D3;          /* (14), where D1 = 1 */
    double M12, M13, M23;
    double g1, g2, g3;      /* M D */
    double mass;            /* D^T M D */
} placed;

INLINE placed place(const double *alpha)
{
    placed a;
    for (int i = 0; i < N; i++) turn(alpha[i], a.s + i, a.c + i);
    const double *s = a.s, *c = a.c;
    a.s21 = s[1] * c[0] - c[1] * s[0], a.c21 = c[1] * c[0] + s[1] * s[0];
    a.s31 = s[2] * c[0] - c[2] * s[0], a.c31 = c[2] * c[0] + s[2] * s[0];
    a.s32 = s[2] * c[1] - c[2] * s[1], a.c32 = c[2] * c[1] + s[2] * s[1];
    a.one_by_s32 = 1 / a.s32;
    a.D2 = -(l[0] / l[1]) * a.s31 * a.one_by_s32;       /* (14): C D = 0 */
    a.D3 = l[0] / l[2] * a.s21 * a.one_by_s32;          /* (14) */
    a.M12 = COUPLING12 * a.c21, a.M13 = COUPLING13 * a.c31, a.M23 = COUPLING23 * a.c32;
    a.g1 = DIAGONAL1 + a.M12 * a.D2 + a.M13 * a.D3;
    a.g2 = a.M12 + DIAGONAL2 * a.D2 + a.M23 * a.D3;
    a.g3 = a.M13 + a.M23 * a.D2 + DIAGONAL3 * a.D3;
    a.mass = a.g1 + a.D2 * a.g2 + a.D3 * a.g3;
    return a;
}

/* y = [alpha, v], rate = [v, vdot] */
INLINE void differentiate(const double *restrict y, double *restrict rate)
{
    const double *v = y + N;
    placed a = place(y);
    double w1 = v[0] * v[0], w2 = v[1] * v[1], w3 = v[2] * v[2];
    double f1 = -MOMENT1 * a.c[0] + COUPLING12 * w2 * a.s21 + COUPLING13 * w3 * a.s31;      /* f - d of (2) */
    double f2 = -MOMENT2 * a.c[1] - COUPLING12 * w1 * a.s21 + COUPLING23 * w3 * a.s32;
    double f3 = -MOMENT3 * a.c[2] - COUPLING13 * w1 * a.s31 - COUPLING23 * w2 * a.s32;
    double gamma2 = (l[0] * w1 * a.c31 + l[1] * w2 * a.c32 + l[2] * w3) * (a.one_by_s32 / l[1]);    /* C gamma = xi, gamma1 = 0 */
    double gamma3 = -(l[0] * w1 * a.c21 + l[1] * w2 + l[2] * w3 * a.c32) * (a.one_by_s32 / l[2]);
    double udot = (f1 + a.D2 * f2 + a.D3 * f3 - a.g2 * gamma2 - a.g3 * gamma3) / a.mass;            /* D^T (2) */
    for (int i = 0; i < N; i++) rate[i] = v[i];
    rate[N + 0] = udot;
    rate[N + 1] = a.D2 * udot + gamma2;         /* (15) */
    rate[N + 2] = a.D3 * udot + gamma3;
}

/* Any x with C x = Phi, less its part along D, is the step of (25) ... (27) in the metric of M. */
INLINE void correct(double *y, double tolerance)
{
    double *v = y + N;
    for (int iteration = 0; iteration < ITERATIONS; iteration++) {
        placed a = place(y);
        double Phi1 = l[0] * a.c[0] + l[1] * a.c[1] + l[2] * a.c[2] - l0, Phi2 = l[0] * a.s[0] + l[1] * a.s[1] + l[2] * a.s[2];
        if (fabs(Phi1) <= tolerance && fabs(Phi2) <= tolerance) {
            double u = (a.g1 * v[0] + a.g2 * v[1] + a.g3 * v[2]) / a.mass;      /* v <- D (D^T M D)^-1 D^T M v: (25b) ... (27b) */
            v[0] = u, v[1] = a.D2 * u, v[2] = a.D3 * u;
            return;
        }
        double x2 = (Phi1 * a.c[2] + Phi2 * a.s[2]) * (a.one_by_s32 / l[1]), x3 = -(Phi1 * a.c[1] + Phi2 * a.s[1]) * (a.one_by_s32 / l[2]);
        double along = (a.g2 * x2 + a.g3 * x3) / a.mass;
        y[0] += along, y[1] -= x2 - a.D2 * along, y[2] -= x3 - a.D3 * along;    /* (25a) ... (27a) */
    }
}

static void rk4(double *y, double h)
{
    double k1[STATE], k2[STATE], k3[STATE], k4[STATE], stage[STATE];
    differentiate(y, k1);
    for (int i = 0; i < STATE; i++) stage[i] = y[i] + h / 2 * k1[i];
    differentiate(stage, k2);
    for (int i = 0; i < STATE; i++) stage[i] = y[i] + h / 2 * k2[i];
    differentiate(stage, k3);
    for (int i = 0; i < STATE; i++) stage[i] = y[i] + h * k3[i];
    differentiate(stage, k4);
    for (int i = 0; i < STATE; i++) y[i] += h / 6 * (k1[i] + 2 * (k2[i] + k3[i]) + k4[i]);
}

double four_bar_floor(const double *start, const double *rates, double h, int steps, double tolerance)
{
    double y[STATE];
    memcpy(y, start, N * sizeof *y);
    memcpy(y + N, rates, N * sizeof *y);
    for (int step = 0; step < steps; step++) {
        rk4(y, h);
        correct(y, tolerance);
    }
    return y[0];
}

/* sum <- sum_j weight_j k_j, unrolled, as all weights are known to the compiler; those that are zero vanish */
#define COMBINE(terms, weight, sum)                                                                 \
    do {                                                                                            \
        for (int i_ = 0; i_ < STATE; i_++) (sum)[i_] = 0;                                           \
        _Pragma("GCC unroll 16") for (int j_ = 0; j_ < (terms); j_++)                               \
            if ((weight)[j_] != 0)                                                                  \
                for (int i_ = 0; i_ < STATE; i_++) (sum)[i_] += (weight)[j_] * k[j_][i_];           \
    } while (0)

/* The twelve stages from k[0] = f(y), without f at the end: to `end`; returns the norm of the error as Hairer's code has it. */
static double dop853_step(const double *restrict y, double h, double rtol, double k[][STATE], double *restrict end)
{
    double stage[STATE], sum[STATE], third[STATE], squares5 = 0, squares3 = 0;
    _Pragma("GCC unroll 16") for (int i = 1; i < 12; i++) {
        COMBINE(i, DOP853_A + 12 * i, sum);
        for (int n = 0; n < STATE; n++) stage[n] = y[n] + h * sum[n];
        differentiate(stage, k[i]);
    }
    COMBINE(12, DOP853_B, sum);
    for (int n = 0; n < STATE; n++) end[n] = y[n] + h * sum[n];
    COMBINE(12, DOP853_E5, sum);
    COMBINE(12, DOP853_E3, third);
    for (int n = 0; n < STATE; n++) {
        double scale = 1 / (rtol + rtol * fmax(fabs(y[n]), fabs(end[n])));
        squares5 += sum[n] * scale * (sum[n] * scale), squares3 += third[n] * scale * (third[n] * scale);
    }
    return squares5 > 0 ? h * squares5 / sqrt((squares5 + 0.01 * squares3) * STATE) : 0;
}

int four_bar_floor_dop853(const double *start, const double *rates, double t1, double rtol, double tolerance, int most, double *t,
                          double *alpha)
{
    double y[STATE], end[STATE], k[12][STATE], now = 0, h = 1e-3;
    int steps = 0;
    memcpy(y, start, N * sizeof *y);
    memcpy(y + N, rates, N * sizeof *y);
    differentiate(y, k[0]);
    while (now < t1 && steps < most) {
        double taken = fmin(h, t1 - now), norm = dop853_step(y, taken, rtol, k, end);
        h = taken * fmin(10, fmax(0.2, norm > 0 ? 0.8 * pow(norm, -1.0 / 8) : 10));
        if (!(norm <= 1)) continue;
        now = taken < t1 - now ? now + taken : t1;
        memcpy(y, end, sizeof y);
        correct(y, tolerance);
        differentiate(y, k[0]);
        t[steps] = now;
        alpha[steps++] = y[0];
    }
    return steps;
}
