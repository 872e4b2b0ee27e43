/* Written by tests/direct_sources.py with SymPy 1.14.0, from tests/symbolic_counterparts.py. */
#include "driven_four_bar.h"

#include <math.h>
#include "../../include/zerodrift/sines.h"

/* What follows from the parameters alone, behind them. */
void zd_driven_four_bar_direct_constants(double *k)
{
    k[15] = (k[1] * ((k[6] + ((k[4] * 0.25) + k[5])) * k[1])) + k[7];
    const double x26 = (k[6] + (k[5] * 0.5)) * k[2];
    k[16] = k[1] * x26;
    k[17] = k[6] * k[1];
    k[18] = k[3] * k[17];
    k[19] = (k[2] * (k[2] * (k[6] + (0.25 * k[5])))) + k[8];
    k[20] = k[6] * k[2];
    k[21] = k[3] * k[20];
    k[22] = k[9] + ((k[3] * k[3]) * (0.25 * k[6]));
    k[23] = 0.5 * k[2];
    k[24] = k[5] * k[1];
    k[25] = 0.5 * k[3];
    k[26] = 0.5 * (k[5] * k[2]);
    k[27] = k[6] * k[3];
    k[28] = (k[1] * ((k[4] * 0.5) + (k[5] + k[6]))) * k[10];
    k[29] = x26 * k[10];
    k[30] = 0.5 * (k[27] * k[10]);
    k[31] = k[14] * k[13];
    k[32] = k[13] * (k[14] * k[14]);
}

static int accelerate_0(const void *data, const double *restrict time, const double *restrict p,
    const double *restrict v, const double *restrict added, double *restrict pdot, double *restrict vdot,
    double *restrict lambda, double *restrict power, double *restrict pivots)
{
    const double *restrict const k = (const double *)data + 18;
    const double t = *time;
    (void)k, (void)t, (void)p, (void)v;
    (void)added, (void)pdot, (void)lambda, (void)power, (void)pivots;
    const double p0 = p[0], p1 = p[1], p2 = p[2];
    const double v0 = v[0], v1 = v[1], v2 = v[2];
    const double added0 = added ? added[0] : 0, added1 = added ? added[1] : 0, added2 = added ? added[2] : 0;
    const double x59 = v0 * v0;
    const double x63 = v1 * v1;
    const double x74 = v2 * v2;
    const double x145 = t * k[14];
    const double angle14[4] = {p0, p1, p2, x145};
    double sine14[4], cosine14[4];
    zd_sines(4, angle14, sine14, cosine14);
    const double x60 = k[1] * sine14[0];
    const double x61 = x59 * x60;
    const double x71 = sine14[1] * k[2];
    const double x78 = x61 + (x63 * x71);
    const double x84 = k[1] * cosine14[0];
    const double x85 = x59 * x84;
    const double x91 = cosine14[1] * k[2];
    const double x95 = x85 + (x63 * x91);
    const double x135 = cosine14[2] * k[3];
    const double x139 = sine14[2] * k[3];
    const double x184 = 1.0 / x91;
    const double x185 = x71 * x184;
    const double x191 = (x135 * x185) - x139;
    const double x192 = 1.0 / x191;
    const double x198 = added2 - (sine14[3] * k[32]);
    const double x209 = ((x78 + (x74 * x139)) + added1) - (x84 * x198);
    const double x213 = x192 * ((((x95 + (x74 * x135)) + added0) + (x60 * x198)) + (x185 * x209));
    const double x216 = x184 * (x209 - (x135 * x213));
    vdot[0] = x198;
    vdot[1] = x216;
    vdot[2] = x213;
    if (lambda || power) {
        const double x28 = ((cosine14[0] * cosine14[1]) + (sine14[0] * sine14[1])) * k[16];
        const double x39 = 0.5 * (((cosine14[0] * cosine14[2]) + (sine14[0] * sine14[2])) * k[18]);
        const double x52 = 0.5 * (((cosine14[1] * cosine14[2]) + (sine14[1] * sine14[2])) * k[21]);
        const double x68 = -(x61 + (x63 * (sine14[1] * k[23])));
        const double x80 = -((x74 * (sine14[2] * k[25])) + x78);
        const double x89 = -(x85 + (x63 * (cosine14[1] * k[23])));
        const double x97 = -((x74 * (cosine14[2] * k[25])) + x95);
        const double x199 = ((cosine14[0] * ((x68 * k[24]) + (k[17] * x80))) - (sine14[0] * ((k[24] * x89) + (k[17] * x97)))) + (cosine14[0] * k[28]);
        const double x201 = ((cosine14[1] * ((x68 * k[26]) + (k[20] * x80))) - (sine14[1] * ((x89 * k[26]) + (k[20] * x97)))) + (cosine14[1] * k[29]);
        const double x236 = ((0.5 * (((cosine14[2] * x80) - (sine14[2] * x97)) * k[27])) + (cosine14[2] * k[30])) + ((k[22] * x213) + ((x39 * x198) + (x52 * x216)));
        const double x238 = x184 * (x201 + ((x52 * x213) + ((x28 * x198) + (k[19] * x216))));
        const double x243 = x192 * ((x135 * x238) - x236);
        const double x246 = (x185 * x243) - x238;
        const double x251 = (x199 + ((x39 * x213) + ((k[15] * x198) + (x28 * x216)))) + ((x84 * x246) - (x60 * x243));
        const double angle158[1] = {x145};
        double sine158[1], cosine158[1];
        zd_sines(1, angle158, sine158, cosine158);
        if (lambda) lambda[0] = x243;
        if (lambda) lambda[1] = x246;
        if (lambda) lambda[2] = -x251;
        if (power) power[0] = (k[12] + (cosine158[0] * k[31])) * x251;
    }
    if (pivots) {
        pivots[0] = 1.0;
        pivots[1] = x91;
        pivots[2] = x191;
    }
    return ZD_DONE;
}

static int correct_0(const void *data, const double *restrict time, const double *restrict p,
    const double *restrict v, double *restrict Phi, double *restrict dp, double *restrict dv)
{
    const double *restrict const k = (const double *)data + 18;
    const double t = *time;
    (void)k, (void)t, (void)p, (void)v;
    (void)Phi;
    const double p0 = p[0], p1 = p[1], p2 = p[2];
    const double v0 = v[0], v1 = v[1], v2 = v[2];
    const double x145 = t * k[14];
    const double angle14[4] = {p0, p1, p2, x145};
    double sine14[4], cosine14[4];
    zd_sines(4, angle14, sine14, cosine14);
    const double x60 = k[1] * sine14[0];
    const double x71 = sine14[1] * k[2];
    const double x84 = k[1] * cosine14[0];
    const double x91 = cosine14[1] * k[2];
    const double x135 = cosine14[2] * k[3];
    const double x138 = x135 + (x91 + (x84 - k[0]));
    const double x139 = sine14[2] * k[3];
    const double x141 = x139 + (x60 + x71);
    const double x153 = ((p0 - k[11]) - (sine14[3] * k[13])) - (t * k[12]);
    const double x184 = 1.0 / x91;
    const double x185 = x71 * x184;
    const double x192 = 1.0 / ((x135 * x185) - x139);
    const double x270 = v0 - (k[12] + (cosine14[3] * k[31]));
    const double x275 = x141 - (x84 * x153);
    const double x279 = x192 * ((x138 + (x60 * x153)) + (x185 * x275));
    const double x287 = ((v2 * x135) + ((v0 * x84) + (v1 * x91))) - (x84 * x270);
    const double x291 = x192 * (((x60 * x270) - ((v2 * x139) + ((v0 * x60) + (v1 * x71)))) + (x185 * x287));
    Phi[0] = x138;
    Phi[1] = x141;
    Phi[2] = x153;
    dp[0] = x153;
    dp[1] = x184 * (x275 - (x135 * x279));
    dp[2] = x279;
    dv[0] = x270;
    dv[1] = x184 * (x287 - (x135 * x291));
    dv[2] = x291;
    return ZD_DONE;
}

static int land_0(const void *data, const double *restrict time, const double *restrict p,
    double *restrict v, const double *restrict allowed, double *restrict Phi, double *restrict dp,
    double *restrict pdot, double *restrict vdot, double *restrict lambda, double *restrict power, double *restrict pivots)
{
    const double *restrict const k = (const double *)data + 18;
    const double t = *time;
    (void)k, (void)t, (void)p, (void)v;
    (void)allowed, (void)Phi, (void)dp, (void)pdot, (void)lambda, (void)power, (void)pivots;
    const double p0 = p[0], p1 = p[1], p2 = p[2];
    const double before0 = v[0], before1 = v[1], before2 = v[2];
    const double x145 = t * k[14];
    const double angle14[4] = {p0, p1, p2, x145};
    double sine14[4], cosine14[4];
    zd_sines(4, angle14, sine14, cosine14);
    const double x60 = k[1] * sine14[0];
    const double x71 = sine14[1] * k[2];
    const double x84 = k[1] * cosine14[0];
    const double x91 = cosine14[1] * k[2];
    const double x135 = cosine14[2] * k[3];
    const double x138 = x135 + (x91 + (x84 - k[0]));
    const double x139 = sine14[2] * k[3];
    const double x141 = x139 + (x60 + x71);
    const double x153 = ((p0 - k[11]) - (sine14[3] * k[13])) - (t * k[12]);
    Phi[0] = x138;
    Phi[1] = x141;
    Phi[2] = x153;
    if (!(fabs(Phi[0]) <= allowed[0]) || !(fabs(Phi[1]) <= allowed[1]) || !(fabs(Phi[2]) <= allowed[2])) {
        const double x184 = 1.0 / x91;
        const double x185 = x71 * x184;
        const double x191 = (x135 * x185) - x139;
        const double x192 = 1.0 / x191;
        const double x275 = x141 - (x84 * x153);
        const double x279 = x192 * ((x138 + (x60 * x153)) + (x185 * x275));
        dp[0] = x153;
        dp[1] = x184 * (x275 - (x135 * x279));
        dp[2] = x279;
        return ZD_NO_CONVERGENCE;
    }
    const double x184 = 1.0 / x91;
    const double x185 = x71 * x184;
    const double x191 = (x135 * x185) - x139;
    const double x192 = 1.0 / x191;
    const double angle158[1] = {x145};
    double sine158[1], cosine158[1];
    zd_sines(1, angle158, sine158, cosine158);
    const double x161 = k[12] + (cosine158[0] * k[31]);
    const double x313 = before0 - x161;
    const double x318 = ((x135 * before2) + ((x84 * before0) + (x91 * before1))) - (x84 * x313);
    const double x322 = x192 * (((x60 * x313) - ((x139 * before2) + ((x60 * before0) + (x71 * before1)))) + (x185 * x318));
    const double v0 = before0 - x313;
    const double v1 = before1 - (x184 * (x318 - (x135 * x322)));
    const double v2 = before2 - x322;
    const double x59 = v0 * v0;
    const double x61 = x59 * x60;
    const double x63 = v1 * v1;
    const double x74 = v2 * v2;
    const double x78 = x61 + (x63 * x71);
    const double x85 = x59 * x84;
    const double x95 = x85 + (x63 * x91);
    const double x169 = sine14[3] * k[32];
    const double x331 = (x78 + (x74 * x139)) + (x84 * x169);
    const double x335 = x192 * (((x95 + (x74 * x135)) - (x60 * x169)) + (x185 * x331));
    const double x338 = x184 * (x331 - (x135 * x335));
    v[0] = v0;
    v[1] = v1;
    v[2] = v2;
    vdot[0] = -x169;
    vdot[1] = x338;
    vdot[2] = x335;
    if (lambda || power) {
        const double x28 = ((cosine14[0] * cosine14[1]) + (sine14[0] * sine14[1])) * k[16];
        const double x39 = 0.5 * (((cosine14[0] * cosine14[2]) + (sine14[0] * sine14[2])) * k[18]);
        const double x52 = 0.5 * (((cosine14[1] * cosine14[2]) + (sine14[1] * sine14[2])) * k[21]);
        const double x68 = -(x61 + (x63 * (sine14[1] * k[23])));
        const double x80 = -((x74 * (sine14[2] * k[25])) + x78);
        const double x89 = -(x85 + (x63 * (cosine14[1] * k[23])));
        const double x97 = -((x74 * (cosine14[2] * k[25])) + x95);
        const double x199 = ((cosine14[0] * ((x68 * k[24]) + (k[17] * x80))) - (sine14[0] * ((k[24] * x89) + (k[17] * x97)))) + (cosine14[0] * k[28]);
        const double x201 = ((cosine14[1] * ((x68 * k[26]) + (k[20] * x80))) - (sine14[1] * ((x89 * k[26]) + (k[20] * x97)))) + (cosine14[1] * k[29]);
        const double x361 = ((0.5 * (((cosine14[2] * x80) - (sine14[2] * x97)) * k[27])) + (cosine14[2] * k[30])) + ((k[22] * x335) + ((x52 * x338) - (x39 * x169)));
        const double x363 = x184 * (x201 + ((x52 * x335) + ((k[19] * x338) - (x28 * x169))));
        const double x368 = x192 * ((x135 * x363) - x361);
        const double x371 = (x185 * x368) - x363;
        const double x376 = (x199 + ((x39 * x335) + ((x28 * x338) - (k[15] * x169)))) + ((x84 * x371) - (x60 * x368));
        if (lambda) lambda[0] = x368;
        if (lambda) lambda[1] = x371;
        if (lambda) lambda[2] = -x376;
        if (power) power[0] = x161 * x376;
    }
    if (pivots) {
        pivots[0] = 1.0;
        pivots[1] = x91;
        pivots[2] = x191;
    }
    return ZD_DONE;
}

static const int solve_0[] = {0, 1, 2};
static const int row_0[] = {2, 1, 0};
static const int column_0[] = {0, 1, 2};

static const zd_elimination orders[] = {
    {3, solve_0, row_0, column_0, accelerate_0, correct_0, land_0},
};

const zd_direct zd_driven_four_bar_direct = {ZD_BASELINE, 1, 1, orders};
