/* Written by tests/direct_sources.py with SymPy 1.14.0, from tests/symbolic_counterparts.py. */
#ifndef ZD_LANES
#include "four_bar.h"

#include <math.h>
#include "../../include/zerodrift/units.h"

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

static const int solve_0[] = {0, 1};
static const int row_0[] = {1, 0};
static const int column_0[] = {1, 2};

/* The functions below, for each vector unit. */
#if (ZD_SETS) & ZD_SET_BASELINE_1
#define ZD_UNIT 0
#define ZD_LANES 1
#include "four_bar.c"
#endif
#if (ZD_SETS) & ZD_SET_BASELINE_2
#define ZD_UNIT 0
#define ZD_LANES 2
#include "four_bar.c"
#endif
#if (ZD_SETS) & ZD_SET_AVX2_1
#define ZD_UNIT 1
#define ZD_LANES 1
#include "four_bar.c"
#endif
#if (ZD_SETS) & ZD_SET_AVX2_4
#define ZD_UNIT 1
#define ZD_LANES 4
#include "four_bar.c"
#endif
#if (ZD_SETS) & ZD_SET_AVX512_1
#define ZD_UNIT 2
#define ZD_LANES 1
#include "four_bar.c"
#endif
#if (ZD_SETS) & ZD_SET_AVX512_8
#define ZD_UNIT 2
#define ZD_LANES 8
#include "four_bar.c"
#endif

const zd_direct zd_four_bar_direct[] = {
#if (ZD_SETS) & ZD_SET_BASELINE_1
    {0, 1, 1, orders_0_1},
#endif
#if (ZD_SETS) & ZD_SET_BASELINE_2
    {0, 2, 1, orders_0_2},
#endif
#if (ZD_SETS) & ZD_SET_AVX2_1
    {1, 1, 1, orders_1_1},
#endif
#if (ZD_SETS) & ZD_SET_AVX2_4
    {1, 4, 1, orders_1_4},
#endif
#if (ZD_SETS) & ZD_SET_AVX512_1
    {2, 1, 1, orders_2_1},
#endif
#if (ZD_SETS) & ZD_SET_AVX512_8
    {2, 8, 1, orders_2_8},
#endif
};

#else
#include "../../include/zerodrift/lanes.h"

ZD_ON_UNIT static int ZD_NAMED(accelerate_0)(const void *data, const double *at_time, const double *at_p,
    const double *at_v, const double *with_added, double *to_pdot, double *to_vdot, double *to_lambda,
    double *to_power, double *to_pivots)
{
    const zd_stored *restrict const k = (const zd_stored *)((const double *)data + 14 * ZD_LANES);
    const zd_stored *restrict const time = (const zd_stored *)at_time;
    const zd_stored *restrict const p = (const zd_stored *)at_p;
    const zd_stored *restrict const v = (const zd_stored *)at_v;
    const zd_stored *restrict const added = (const zd_stored *)with_added;
    zd_stored *restrict const pdot = (zd_stored *)to_pdot;
    zd_stored *restrict const vdot = (zd_stored *)to_vdot;
    zd_stored *restrict const lambda = (zd_stored *)to_lambda;
    zd_stored *restrict const power = (zd_stored *)to_power;
    zd_stored *restrict const pivots = (zd_stored *)to_pivots;
    const zd_real t = *time;
    (void)t, (void)k, (void)time, (void)p, (void)v, (void)added, (void)pdot, (void)vdot, (void)lambda, (void)power, (void)pivots;
    const zd_real p0 = p[0], p1 = p[1], p2 = p[2];
    const zd_real v0 = v[0], v1 = v[1], v2 = v[2];
    const zd_real added0 = added ? (zd_real)added[0] : ZD_SPLAT(0.0), added1 = added ? (zd_real)added[1] : ZD_SPLAT(0.0);
    const zd_real x59 = v0 * v0;
    const zd_real x63 = v1 * v1;
    const zd_real x74 = v2 * v2;
    const zd_real angle14[ZD_PADDED(3)] = {p0, p1, p2};
    zd_real sine14[ZD_PADDED(3)], cosine14[ZD_PADDED(3)];
    ZD_SINES(3, angle14, sine14, cosine14);
    const zd_real x28 = ZD_FMA(sine14[0], sine14[1], cosine14[0] * cosine14[1]) * k[12];
    const zd_real x39 = 0.5 * (ZD_FMA(sine14[0], sine14[2], cosine14[0] * cosine14[2]) * k[14]);
    const zd_real x52 = 0.5 * (ZD_FMA(sine14[1], sine14[2], cosine14[1] * cosine14[2]) * k[17]);
    const zd_real x60 = k[1] * sine14[0];
    const zd_real x61 = x59 * x60;
    const zd_real x68 = -ZD_FMA(x63, sine14[1] * k[19], x61);
    const zd_real x71 = sine14[1] * k[2];
    const zd_real x78 = ZD_FMA(x63, x71, x61);
    const zd_real x80 = -ZD_FMA(x74, sine14[2] * k[21], x78);
    const zd_real x84 = k[1] * cosine14[0];
    const zd_real x85 = x59 * x84;
    const zd_real x89 = -ZD_FMA(x63, cosine14[1] * k[19], x85);
    const zd_real x91 = cosine14[1] * k[2];
    const zd_real x95 = ZD_FMA(x63, x91, x85);
    const zd_real x97 = -ZD_FMA(x74, cosine14[2] * k[21], x95);
    const zd_real x135 = cosine14[2] * k[3];
    const zd_real x139 = sine14[2] * k[3];
    const zd_real x163 = 1.0 / x91;
    const zd_real x164 = x71 * x163;
    const zd_real x173 = ZD_FMS(x135, x164, x139);
    const zd_real x174 = 1.0 / x173;
    const zd_real x176 = ZD_FMS(x84, x164, x60) * x174;
    const zd_real x182 = x163 * ZD_FNMA(x135, x176, x84);
    const zd_real x195 = ZD_FNMA(x52, x176, ZD_FNMA(k[15], x182, x28));
    const zd_real x201 = ZD_FNMA(k[18], x176, ZD_FNMA(x52, x182, x39));
    const zd_real x213 = ZD_FMA(x74, x139, x78) + added1;
    const zd_real x214 = ZD_FMA(cosine14[0], k[24], ZD_FNMA(sine14[0], ZD_FMA(k[13], x97, k[20] * x89), cosine14[0] * ZD_FMA(k[13], x80, x68 * k[20])));
    const zd_real x216 = ZD_FMA(cosine14[1], k[25], ZD_FNMA(sine14[1], ZD_FMA(k[16], x97, x89 * k[22]), cosine14[1] * ZD_FMA(k[16], x80, x68 * k[22])));
    const zd_real x218 = ZD_FMA(cosine14[2], k[26], 0.5 * (ZD_FNMA(sine14[2], x97, cosine14[2] * x80) * k[23]));
    const zd_real x223 = x174 * ZD_FMA(x164, x213, ZD_FMA(x74, x135, x95) + added0);
    const zd_real x226 = x163 * ZD_FNMA(x135, x223, x213);
    const zd_real x238 = (1.0 / ZD_FNMA(x176, x201, ZD_FNMA(x182, x195, ZD_FNMA(x39, x176, ZD_FNMA(x28, x182, k[11]))))) * (ZD_FMA(x176, x218, ZD_FMS(x182, x216, x214)) - ZD_FMA(x201, x223, x195 * x226));
    const zd_real x241 = ZD_FNMA(x182, x238, x226);
    const zd_real x244 = ZD_FNMA(x176, x238, x223);
    vdot[0] = x238;
    vdot[1] = x241;
    vdot[2] = x244;
    if (lambda || power) {
        const zd_real x266 = x163 * (x216 + ZD_FMA(x52, x244, ZD_FMA(k[15], x241, x28 * x238)));
        const zd_real x271 = x174 * ZD_FMS(x135, x266, x218 + ZD_FMA(k[18], x244, ZD_FMA(x52, x241, x39 * x238)));
        if (lambda) lambda[0] = x271;
        if (lambda) lambda[1] = ZD_FMS(x164, x271, x266);
        if (power) power[0] = ZD_SPLAT(0.0);
    }
    if (pivots) {
        pivots[0] = x91;
        pivots[1] = x173;
        pivots[2] = ZD_SPLAT(1.0);
    }
    return ZD_DONE;
}

ZD_ON_UNIT static int ZD_NAMED(correct_0)(const void *data, const double *at_time, const double *at_p,
    const double *at_v, double *to_Phi, double *to_dp, double *to_dv)
{
    const zd_stored *restrict const k = (const zd_stored *)((const double *)data + 14 * ZD_LANES);
    const zd_stored *restrict const time = (const zd_stored *)at_time;
    const zd_stored *restrict const p = (const zd_stored *)at_p;
    const zd_stored *restrict const v = (const zd_stored *)at_v;
    zd_stored *restrict const Phi = (zd_stored *)to_Phi;
    zd_stored *restrict const dp = (zd_stored *)to_dp;
    zd_stored *restrict const dv = (zd_stored *)to_dv;
    const zd_real t = *time;
    (void)t, (void)k, (void)time, (void)p, (void)v, (void)Phi, (void)dp, (void)dv;
    const zd_real p0 = p[0], p1 = p[1], p2 = p[2];
    const zd_real v0 = v[0], v1 = v[1], v2 = v[2];
    const zd_real angle14[ZD_PADDED(3)] = {p0, p1, p2};
    zd_real sine14[ZD_PADDED(3)], cosine14[ZD_PADDED(3)];
    ZD_SINES(3, angle14, sine14, cosine14);
    const zd_real x28 = ZD_FMA(sine14[0], sine14[1], cosine14[0] * cosine14[1]) * k[12];
    const zd_real x39 = 0.5 * (ZD_FMA(sine14[0], sine14[2], cosine14[0] * cosine14[2]) * k[14]);
    const zd_real x52 = 0.5 * (ZD_FMA(sine14[1], sine14[2], cosine14[1] * cosine14[2]) * k[17]);
    const zd_real x60 = k[1] * sine14[0];
    const zd_real x71 = sine14[1] * k[2];
    const zd_real x84 = k[1] * cosine14[0];
    const zd_real x91 = cosine14[1] * k[2];
    const zd_real x135 = cosine14[2] * k[3];
    const zd_real x138 = x135 + (x91 + (x84 - k[0]));
    const zd_real x139 = sine14[2] * k[3];
    const zd_real x141 = x139 + (x60 + x71);
    const zd_real x163 = 1.0 / x91;
    const zd_real x164 = x71 * x163;
    const zd_real x174 = 1.0 / ZD_FMS(x135, x164, x139);
    const zd_real x176 = ZD_FMS(x84, x164, x60) * x174;
    const zd_real x182 = x163 * ZD_FNMA(x135, x176, x84);
    const zd_real x195 = ZD_FNMA(x52, x176, ZD_FNMA(k[15], x182, x28));
    const zd_real x201 = ZD_FNMA(k[18], x176, ZD_FNMA(x52, x182, x39));
    const zd_real x208 = 1.0 / ZD_FNMA(x176, x201, ZD_FNMA(x182, x195, ZD_FNMA(x39, x176, ZD_FNMA(x28, x182, k[11]))));
    const zd_real x289 = ZD_FMA(v2, x135, ZD_FMA(v1, x91, v0 * x84));
    const zd_real x293 = x174 * ZD_FMA(x141, x164, x138);
    const zd_real x296 = x163 * ZD_FNMA(x135, x293, x141);
    const zd_real x301 = x208 * ZD_FMA(x201, x293, x195 * x296);
    const zd_real x312 = x174 * ZD_FMS(x164, x289, ZD_FMA(v2, x139, ZD_FMA(v1, x71, v0 * x60)));
    const zd_real x315 = x163 * ZD_FNMA(x135, x312, x289);
    const zd_real x320 = x208 * ZD_FMA(x201, x312, x195 * x315);
    Phi[0] = x138;
    Phi[1] = x141;
    dp[0] = -x301;
    dp[1] = ZD_FMA(x182, x301, x296);
    dp[2] = ZD_FMA(x176, x301, x293);
    dv[0] = -x320;
    dv[1] = ZD_FMA(x182, x320, x315);
    dv[2] = ZD_FMA(x176, x320, x312);
    return ZD_DONE;
}

#if ZD_LANES == 1
ZD_ON_UNIT static int ZD_NAMED(land_0)(const void *data, const double *at_time, const double *at_p,
    double *to_v, const double *where_allowed, double *to_Phi, double *to_dp, double *to_pdot, double *to_vdot,
    double *to_lambda, double *to_power, double *to_pivots)
{
    const zd_stored *restrict const k = (const zd_stored *)((const double *)data + 14 * ZD_LANES);
    const zd_stored *restrict const time = (const zd_stored *)at_time;
    const zd_stored *restrict const p = (const zd_stored *)at_p;
    const zd_stored *restrict const allowed = (const zd_stored *)where_allowed;
    zd_stored *restrict const v = (zd_stored *)to_v;
    zd_stored *restrict const Phi = (zd_stored *)to_Phi;
    zd_stored *restrict const dp = (zd_stored *)to_dp;
    zd_stored *restrict const pdot = (zd_stored *)to_pdot;
    zd_stored *restrict const vdot = (zd_stored *)to_vdot;
    zd_stored *restrict const lambda = (zd_stored *)to_lambda;
    zd_stored *restrict const power = (zd_stored *)to_power;
    zd_stored *restrict const pivots = (zd_stored *)to_pivots;
    const zd_real t = *time;
    (void)t, (void)k, (void)time, (void)p, (void)allowed, (void)v, (void)Phi, (void)dp, (void)pdot, (void)vdot, (void)lambda, (void)power, (void)pivots;
    const zd_real p0 = p[0], p1 = p[1], p2 = p[2];
    const zd_real before0 = v[0], before1 = v[1], before2 = v[2];
    const zd_real angle14[ZD_PADDED(3)] = {p0, p1, p2};
    zd_real sine14[ZD_PADDED(3)], cosine14[ZD_PADDED(3)];
    ZD_SINES(3, angle14, sine14, cosine14);
    const zd_real x60 = k[1] * sine14[0];
    const zd_real x71 = sine14[1] * k[2];
    const zd_real x84 = k[1] * cosine14[0];
    const zd_real x91 = cosine14[1] * k[2];
    const zd_real x135 = cosine14[2] * k[3];
    const zd_real x138 = x135 + (x91 + (x84 - k[0]));
    const zd_real x139 = sine14[2] * k[3];
    const zd_real x141 = x139 + (x60 + x71);
    Phi[0] = x138;
    Phi[1] = x141;
    if (!(fabs(Phi[0]) <= allowed[0]) || !(fabs(Phi[1]) <= allowed[1])) {
        const zd_real x28 = ZD_FMA(sine14[0], sine14[1], cosine14[0] * cosine14[1]) * k[12];
        const zd_real x39 = 0.5 * (ZD_FMA(sine14[0], sine14[2], cosine14[0] * cosine14[2]) * k[14]);
        const zd_real x52 = 0.5 * (ZD_FMA(sine14[1], sine14[2], cosine14[1] * cosine14[2]) * k[17]);
        const zd_real x163 = 1.0 / x91;
        const zd_real x164 = x71 * x163;
        const zd_real x173 = ZD_FMS(x135, x164, x139);
        const zd_real x174 = 1.0 / x173;
        const zd_real x176 = ZD_FMS(x84, x164, x60) * x174;
        const zd_real x182 = x163 * ZD_FNMA(x135, x176, x84);
        const zd_real x195 = ZD_FNMA(x52, x176, ZD_FNMA(k[15], x182, x28));
        const zd_real x201 = ZD_FNMA(k[18], x176, ZD_FNMA(x52, x182, x39));
        const zd_real x208 = 1.0 / ZD_FNMA(x176, x201, ZD_FNMA(x182, x195, ZD_FNMA(x39, x176, ZD_FNMA(x28, x182, k[11]))));
        const zd_real x293 = x174 * ZD_FMA(x141, x164, x138);
        const zd_real x296 = x163 * ZD_FNMA(x135, x293, x141);
        const zd_real x301 = x208 * ZD_FMA(x201, x293, x195 * x296);
        dp[0] = -x301;
        dp[1] = ZD_FMA(x182, x301, x296);
        dp[2] = ZD_FMA(x176, x301, x293);
        return ZD_NO_CONVERGENCE;
    }
    const zd_real x28 = ZD_FMA(sine14[0], sine14[1], cosine14[0] * cosine14[1]) * k[12];
    const zd_real x39 = 0.5 * (ZD_FMA(sine14[0], sine14[2], cosine14[0] * cosine14[2]) * k[14]);
    const zd_real x52 = 0.5 * (ZD_FMA(sine14[1], sine14[2], cosine14[1] * cosine14[2]) * k[17]);
    const zd_real x163 = 1.0 / x91;
    const zd_real x164 = x71 * x163;
    const zd_real x173 = ZD_FMS(x135, x164, x139);
    const zd_real x174 = 1.0 / x173;
    const zd_real x176 = ZD_FMS(x84, x164, x60) * x174;
    const zd_real x182 = x163 * ZD_FNMA(x135, x176, x84);
    const zd_real x195 = ZD_FNMA(x52, x176, ZD_FNMA(k[15], x182, x28));
    const zd_real x201 = ZD_FNMA(k[18], x176, ZD_FNMA(x52, x182, x39));
    const zd_real x208 = 1.0 / ZD_FNMA(x176, x201, ZD_FNMA(x182, x195, ZD_FNMA(x39, x176, ZD_FNMA(x28, x182, k[11]))));
    const zd_real x345 = ZD_FMA(x135, before2, ZD_FMA(x91, before1, x84 * before0));
    const zd_real x349 = x174 * ZD_FMS(x164, x345, ZD_FMA(x139, before2, ZD_FMA(x71, before1, x60 * before0)));
    const zd_real x352 = x163 * ZD_FNMA(x135, x349, x345);
    const zd_real x357 = x208 * ZD_FMA(x201, x349, x195 * x352);
    const zd_real v0 = before0 - (-x357);
    const zd_real v1 = before1 - ZD_FMA(x182, x357, x352);
    const zd_real v2 = before2 - ZD_FMA(x176, x357, x349);
    const zd_real x59 = v0 * v0;
    const zd_real x61 = x59 * x60;
    const zd_real x63 = v1 * v1;
    const zd_real x68 = -ZD_FMA(x63, sine14[1] * k[19], x61);
    const zd_real x74 = v2 * v2;
    const zd_real x78 = ZD_FMA(x63, x71, x61);
    const zd_real x80 = -ZD_FMA(x74, sine14[2] * k[21], x78);
    const zd_real x85 = x59 * x84;
    const zd_real x89 = -ZD_FMA(x63, cosine14[1] * k[19], x85);
    const zd_real x95 = ZD_FMA(x63, x91, x85);
    const zd_real x97 = -ZD_FMA(x74, cosine14[2] * k[21], x95);
    const zd_real x148 = ZD_FMA(x74, x139, x78);
    const zd_real x214 = ZD_FMA(cosine14[0], k[24], ZD_FNMA(sine14[0], ZD_FMA(k[13], x97, k[20] * x89), cosine14[0] * ZD_FMA(k[13], x80, x68 * k[20])));
    const zd_real x216 = ZD_FMA(cosine14[1], k[25], ZD_FNMA(sine14[1], ZD_FMA(k[16], x97, x89 * k[22]), cosine14[1] * ZD_FMA(k[16], x80, x68 * k[22])));
    const zd_real x218 = ZD_FMA(cosine14[2], k[26], 0.5 * (ZD_FNMA(sine14[2], x97, cosine14[2] * x80) * k[23]));
    const zd_real x368 = x174 * ZD_FMA(x148, x164, ZD_FMA(x74, x135, x95));
    const zd_real x371 = x163 * ZD_FNMA(x135, x368, x148);
    const zd_real x377 = x208 * (ZD_FMA(x176, x218, ZD_FMS(x182, x216, x214)) - ZD_FMA(x201, x368, x195 * x371));
    const zd_real x380 = ZD_FNMA(x182, x377, x371);
    const zd_real x383 = ZD_FNMA(x176, x377, x368);
    v[0] = v0;
    v[1] = v1;
    v[2] = v2;
    vdot[0] = x377;
    vdot[1] = x380;
    vdot[2] = x383;
    if (lambda || power) {
        const zd_real x405 = x163 * (x216 + ZD_FMA(x52, x383, ZD_FMA(k[15], x380, x28 * x377)));
        const zd_real x410 = x174 * ZD_FMS(x135, x405, x218 + ZD_FMA(k[18], x383, ZD_FMA(x52, x380, x39 * x377)));
        if (lambda) lambda[0] = x410;
        if (lambda) lambda[1] = ZD_FMS(x164, x410, x405);
        if (power) power[0] = ZD_SPLAT(0.0);
    }
    if (pivots) {
        pivots[0] = x91;
        pivots[1] = x173;
        pivots[2] = ZD_SPLAT(1.0);
    }
    return ZD_DONE;
}
#endif

#if ZD_LANES == 1
#define ZD_LANDING(name) ZD_NAMED(name)
#else
#define ZD_LANDING(name) NULL
#endif
static const zd_elimination ZD_NAMED(orders)[] = {
    {2, solve_0, row_0, column_0, ZD_NAMED(accelerate_0), ZD_NAMED(correct_0), ZD_LANDING(land_0)},
};
#undef ZD_LANDING

#undef ZD_UNIT
#undef ZD_LANES
#endif
