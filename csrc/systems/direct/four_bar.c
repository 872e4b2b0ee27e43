/* Written by tests/direct_sources.py with SymPy 1.14.0, from tests/symbolic_counterparts.py. */
#include "four_bar.h"

#include <math.h>
#include "../../include/zerodrift/sines.h"

/* What follows from the parameters alone, behind them. */
void zd_four_bar_direct_constants(double *k)
{
    k[11] = (k[1] * ((k[6] + ((k[4] * 0.25) + k[5])) * k[1])) + k[7];
    const double x26 = (k[6] + (k[5] * 0.5)) * k[2];
    k[12] = k[1] * x26;
    k[13] = k[6] * k[1];
    k[14] = k[3] * k[13];
    k[15] = (k[2] * (k[2] * (k[6] + (0.25 * k[5])))) + k[8];
    k[16] = k[6] * k[2];
    k[17] = k[3] * k[16];
    k[18] = k[9] + ((k[3] * k[3]) * (0.25 * k[6]));
    k[19] = 0.5 * k[2];
    k[20] = k[5] * k[1];
    k[21] = 0.5 * k[3];
    k[22] = 0.5 * (k[5] * k[2]);
    k[23] = k[6] * k[3];
    k[24] = (k[1] * ((k[4] * 0.5) + (k[5] + k[6]))) * k[10];
    k[25] = x26 * k[10];
    k[26] = 0.5 * (k[23] * k[10]);
}

static int accelerate_0(const void *data, const double *restrict time, const double *restrict p,
    const double *restrict v, const double *restrict added, double *restrict pdot, double *restrict vdot,
    double *restrict lambda, double *restrict power, double *restrict pivots)
{
    const double *restrict const k = (const double *)data + 14;
    const double t = *time;
    (void)k, (void)t, (void)p, (void)v;
    (void)added, (void)pdot, (void)lambda, (void)power, (void)pivots;
    const double p0 = p[0], p1 = p[1], p2 = p[2];
    const double v0 = v[0], v1 = v[1], v2 = v[2];
    const double added0 = added ? added[0] : 0, added1 = added ? added[1] : 0;
    const double x59 = v0 * v0;
    const double x63 = v1 * v1;
    const double x74 = v2 * v2;
    const double angle14[3] = {p0, p1, p2};
    double sine14[3], cosine14[3];
    zd_sines(3, angle14, sine14, cosine14);
    const double x28 = ((cosine14[0] * cosine14[1]) + (sine14[0] * sine14[1])) * k[12];
    const double x39 = 0.5 * (((cosine14[0] * cosine14[2]) + (sine14[0] * sine14[2])) * k[14]);
    const double x52 = 0.5 * (((cosine14[1] * cosine14[2]) + (sine14[1] * sine14[2])) * k[17]);
    const double x60 = k[1] * sine14[0];
    const double x61 = x59 * x60;
    const double x68 = -(x61 + (x63 * (sine14[1] * k[19])));
    const double x71 = sine14[1] * k[2];
    const double x78 = x61 + (x63 * x71);
    const double x80 = -((x74 * (sine14[2] * k[21])) + x78);
    const double x84 = k[1] * cosine14[0];
    const double x85 = x59 * x84;
    const double x89 = -(x85 + (x63 * (cosine14[1] * k[19])));
    const double x91 = cosine14[1] * k[2];
    const double x95 = x85 + (x63 * x91);
    const double x97 = -((x74 * (cosine14[2] * k[21])) + x95);
    const double x135 = cosine14[2] * k[3];
    const double x139 = sine14[2] * k[3];
    const double x163 = 1.0 / x91;
    const double x164 = x71 * x163;
    const double x173 = (x135 * x164) - x139;
    const double x174 = 1.0 / x173;
    const double x176 = ((x84 * x164) - x60) * x174;
    const double x182 = x163 * (x84 - (x135 * x176));
    const double x195 = (x28 - (k[15] * x182)) - (x52 * x176);
    const double x201 = (x39 - (x52 * x182)) - (k[18] * x176);
    const double x213 = (x78 + (x74 * x139)) + added1;
    const double x214 = ((cosine14[0] * ((x68 * k[20]) + (k[13] * x80))) - (sine14[0] * ((k[20] * x89) + (k[13] * x97)))) + (cosine14[0] * k[24]);
    const double x216 = ((cosine14[1] * ((x68 * k[22]) + (k[16] * x80))) - (sine14[1] * ((x89 * k[22]) + (k[16] * x97)))) + (cosine14[1] * k[25]);
    const double x218 = (0.5 * (((cosine14[2] * x80) - (sine14[2] * x97)) * k[23])) + (cosine14[2] * k[26]);
    const double x223 = x174 * (((x95 + (x74 * x135)) + added0) + (x164 * x213));
    const double x226 = x163 * (x213 - (x135 * x223));
    const double x238 = (1.0 / ((((k[11] - (x28 * x182)) - (x39 * x176)) - (x182 * x195)) - (x176 * x201))) * (((x176 * x218) + ((x182 * x216) - x214)) - ((x195 * x226) + (x201 * x223)));
    const double x241 = x226 - (x182 * x238);
    const double x244 = x223 - (x176 * x238);
    vdot[0] = x238;
    vdot[1] = x241;
    vdot[2] = x244;
    if (lambda || power) {
        const double x266 = x163 * (x216 + ((x52 * x244) + ((x28 * x238) + (k[15] * x241))));
        const double x271 = x174 * ((x135 * x266) - (x218 + ((k[18] * x244) + ((x39 * x238) + (x52 * x241)))));
        if (lambda) lambda[0] = x271;
        if (lambda) lambda[1] = (x164 * x271) - x266;
        if (power) power[0] = 0.0;
    }
    if (pivots) {
        pivots[0] = x91;
        pivots[1] = x173;
        pivots[2] = 1.0;
    }
    return ZD_DONE;
}

static int correct_0(const void *data, const double *restrict time, const double *restrict p,
    const double *restrict v, double *restrict Phi, double *restrict dp, double *restrict dv)
{
    const double *restrict const k = (const double *)data + 14;
    const double t = *time;
    (void)k, (void)t, (void)p, (void)v;
    (void)Phi;
    const double p0 = p[0], p1 = p[1], p2 = p[2];
    const double v0 = v[0], v1 = v[1], v2 = v[2];
    const double angle14[3] = {p0, p1, p2};
    double sine14[3], cosine14[3];
    zd_sines(3, angle14, sine14, cosine14);
    const double x28 = ((cosine14[0] * cosine14[1]) + (sine14[0] * sine14[1])) * k[12];
    const double x39 = 0.5 * (((cosine14[0] * cosine14[2]) + (sine14[0] * sine14[2])) * k[14]);
    const double x52 = 0.5 * (((cosine14[1] * cosine14[2]) + (sine14[1] * sine14[2])) * k[17]);
    const double x60 = k[1] * sine14[0];
    const double x71 = sine14[1] * k[2];
    const double x84 = k[1] * cosine14[0];
    const double x91 = cosine14[1] * k[2];
    const double x135 = cosine14[2] * k[3];
    const double x138 = x135 + (x91 + (x84 - k[0]));
    const double x139 = sine14[2] * k[3];
    const double x141 = x139 + (x60 + x71);
    const double x163 = 1.0 / x91;
    const double x164 = x71 * x163;
    const double x174 = 1.0 / ((x135 * x164) - x139);
    const double x176 = ((x84 * x164) - x60) * x174;
    const double x182 = x163 * (x84 - (x135 * x176));
    const double x195 = (x28 - (k[15] * x182)) - (x52 * x176);
    const double x201 = (x39 - (x52 * x182)) - (k[18] * x176);
    const double x208 = 1.0 / ((((k[11] - (x28 * x182)) - (x39 * x176)) - (x182 * x195)) - (x176 * x201));
    const double x289 = (v2 * x135) + ((v0 * x84) + (v1 * x91));
    const double x293 = x174 * (x138 + (x141 * x164));
    const double x296 = x163 * (x141 - (x135 * x293));
    const double x301 = x208 * ((x195 * x296) + (x201 * x293));
    const double x312 = x174 * ((x164 * x289) - ((v2 * x139) + ((v0 * x60) + (v1 * x71))));
    const double x315 = x163 * (x289 - (x135 * x312));
    const double x320 = x208 * ((x195 * x315) + (x201 * x312));
    Phi[0] = x138;
    Phi[1] = x141;
    dp[0] = -x301;
    dp[1] = x296 + (x182 * x301);
    dp[2] = x293 + (x176 * x301);
    dv[0] = -x320;
    dv[1] = x315 + (x182 * x320);
    dv[2] = x312 + (x176 * x320);
    return ZD_DONE;
}

static int land_0(const void *data, const double *restrict time, const double *restrict p,
    double *restrict v, const double *restrict allowed, double *restrict Phi, double *restrict dp,
    double *restrict pdot, double *restrict vdot, double *restrict lambda, double *restrict power, double *restrict pivots)
{
    const double *restrict const k = (const double *)data + 14;
    const double t = *time;
    (void)k, (void)t, (void)p, (void)v;
    (void)allowed, (void)Phi, (void)dp, (void)pdot, (void)lambda, (void)power, (void)pivots;
    const double p0 = p[0], p1 = p[1], p2 = p[2];
    const double before0 = v[0], before1 = v[1], before2 = v[2];
    const double angle14[3] = {p0, p1, p2};
    double sine14[3], cosine14[3];
    zd_sines(3, angle14, sine14, cosine14);
    const double x60 = k[1] * sine14[0];
    const double x71 = sine14[1] * k[2];
    const double x84 = k[1] * cosine14[0];
    const double x91 = cosine14[1] * k[2];
    const double x135 = cosine14[2] * k[3];
    const double x138 = x135 + (x91 + (x84 - k[0]));
    const double x139 = sine14[2] * k[3];
    const double x141 = x139 + (x60 + x71);
    Phi[0] = x138;
    Phi[1] = x141;
    if (!(fabs(Phi[0]) <= allowed[0]) || !(fabs(Phi[1]) <= allowed[1])) {
        const double x28 = ((cosine14[0] * cosine14[1]) + (sine14[0] * sine14[1])) * k[12];
        const double x39 = 0.5 * (((cosine14[0] * cosine14[2]) + (sine14[0] * sine14[2])) * k[14]);
        const double x52 = 0.5 * (((cosine14[1] * cosine14[2]) + (sine14[1] * sine14[2])) * k[17]);
        const double x163 = 1.0 / x91;
        const double x164 = x71 * x163;
        const double x173 = (x135 * x164) - x139;
        const double x174 = 1.0 / x173;
        const double x176 = ((x84 * x164) - x60) * x174;
        const double x182 = x163 * (x84 - (x135 * x176));
        const double x195 = (x28 - (k[15] * x182)) - (x52 * x176);
        const double x201 = (x39 - (x52 * x182)) - (k[18] * x176);
        const double x208 = 1.0 / ((((k[11] - (x28 * x182)) - (x39 * x176)) - (x182 * x195)) - (x176 * x201));
        const double x293 = x174 * (x138 + (x141 * x164));
        const double x296 = x163 * (x141 - (x135 * x293));
        const double x301 = x208 * ((x195 * x296) + (x201 * x293));
        dp[0] = -x301;
        dp[1] = x296 + (x182 * x301);
        dp[2] = x293 + (x176 * x301);
        return ZD_NO_CONVERGENCE;
    }
    const double x28 = ((cosine14[0] * cosine14[1]) + (sine14[0] * sine14[1])) * k[12];
    const double x39 = 0.5 * (((cosine14[0] * cosine14[2]) + (sine14[0] * sine14[2])) * k[14]);
    const double x52 = 0.5 * (((cosine14[1] * cosine14[2]) + (sine14[1] * sine14[2])) * k[17]);
    const double x163 = 1.0 / x91;
    const double x164 = x71 * x163;
    const double x173 = (x135 * x164) - x139;
    const double x174 = 1.0 / x173;
    const double x176 = ((x84 * x164) - x60) * x174;
    const double x182 = x163 * (x84 - (x135 * x176));
    const double x195 = (x28 - (k[15] * x182)) - (x52 * x176);
    const double x201 = (x39 - (x52 * x182)) - (k[18] * x176);
    const double x208 = 1.0 / ((((k[11] - (x28 * x182)) - (x39 * x176)) - (x182 * x195)) - (x176 * x201));
    const double x345 = (x135 * before2) + ((x84 * before0) + (x91 * before1));
    const double x349 = x174 * ((x164 * x345) - ((x139 * before2) + ((x60 * before0) + (x71 * before1))));
    const double x352 = x163 * (x345 - (x135 * x349));
    const double x357 = x208 * ((x195 * x352) + (x201 * x349));
    const double v0 = before0 - (-x357);
    const double v1 = before1 - (x352 + (x182 * x357));
    const double v2 = before2 - (x349 + (x176 * x357));
    const double x59 = v0 * v0;
    const double x61 = x59 * x60;
    const double x63 = v1 * v1;
    const double x68 = -(x61 + (x63 * (sine14[1] * k[19])));
    const double x74 = v2 * v2;
    const double x78 = x61 + (x63 * x71);
    const double x80 = -((x74 * (sine14[2] * k[21])) + x78);
    const double x85 = x59 * x84;
    const double x89 = -(x85 + (x63 * (cosine14[1] * k[19])));
    const double x95 = x85 + (x63 * x91);
    const double x97 = -((x74 * (cosine14[2] * k[21])) + x95);
    const double x148 = x78 + (x74 * x139);
    const double x214 = ((cosine14[0] * ((x68 * k[20]) + (k[13] * x80))) - (sine14[0] * ((k[20] * x89) + (k[13] * x97)))) + (cosine14[0] * k[24]);
    const double x216 = ((cosine14[1] * ((x68 * k[22]) + (k[16] * x80))) - (sine14[1] * ((x89 * k[22]) + (k[16] * x97)))) + (cosine14[1] * k[25]);
    const double x218 = (0.5 * (((cosine14[2] * x80) - (sine14[2] * x97)) * k[23])) + (cosine14[2] * k[26]);
    const double x368 = x174 * ((x95 + (x74 * x135)) + (x148 * x164));
    const double x371 = x163 * (x148 - (x135 * x368));
    const double x377 = x208 * (((x176 * x218) + ((x182 * x216) - x214)) - ((x195 * x371) + (x201 * x368)));
    const double x380 = x371 - (x182 * x377);
    const double x383 = x368 - (x176 * x377);
    v[0] = v0;
    v[1] = v1;
    v[2] = v2;
    vdot[0] = x377;
    vdot[1] = x380;
    vdot[2] = x383;
    if (lambda || power) {
        const double x405 = x163 * (x216 + ((x52 * x383) + ((x28 * x377) + (k[15] * x380))));
        const double x410 = x174 * ((x135 * x405) - (x218 + ((k[18] * x383) + ((x39 * x377) + (x52 * x380)))));
        if (lambda) lambda[0] = x410;
        if (lambda) lambda[1] = (x164 * x410) - x405;
        if (power) power[0] = 0.0;
    }
    if (pivots) {
        pivots[0] = x91;
        pivots[1] = x173;
        pivots[2] = 1.0;
    }
    return ZD_DONE;
}

static const int solve_0[] = {0, 1};
static const int row_0[] = {1, 0};
static const int column_0[] = {1, 2};

static const zd_elimination orders[] = {
    {2, solve_0, row_0, column_0, accelerate_0, correct_0, land_0},
};

const zd_direct zd_four_bar_direct = {ZD_BASELINE, 1, 1, orders};
