/* Written by tests/direct_sources.py with SymPy 1.14.0, from tests/symbolic_counterparts.py. */
#ifndef ZD_LANES
#include "chaplygin_sleigh.h"

#include <math.h>
#include "../../include/zerodrift/units.h"

/* What follows from the parameters alone, behind them. */
void zd_chaplygin_sleigh_direct_constants(double *k)
{
    k[6] = k[0] * k[2];
    k[7] = k[1] + (k[0] * (k[2] * k[2]));
}

static const int solve_0[] = {0};
static const int row_0[] = {0};
static const int column_0[] = {1};
static const int solve_1[] = {0};
static const int row_1[] = {0};
static const int column_1[] = {0};

/* The functions below, for each vector unit. */
#if (ZD_SETS) & ZD_SET_BASELINE_1
#define ZD_UNIT 0
#define ZD_LANES 1
#include "chaplygin_sleigh.c"
#endif
#if (ZD_SETS) & ZD_SET_BASELINE_2
#define ZD_UNIT 0
#define ZD_LANES 2
#include "chaplygin_sleigh.c"
#endif
#if (ZD_SETS) & ZD_SET_AVX2_1
#define ZD_UNIT 1
#define ZD_LANES 1
#include "chaplygin_sleigh.c"
#endif
#if (ZD_SETS) & ZD_SET_AVX2_4
#define ZD_UNIT 1
#define ZD_LANES 4
#include "chaplygin_sleigh.c"
#endif
#if (ZD_SETS) & ZD_SET_AVX512_1
#define ZD_UNIT 2
#define ZD_LANES 1
#include "chaplygin_sleigh.c"
#endif
#if (ZD_SETS) & ZD_SET_AVX512_8
#define ZD_UNIT 2
#define ZD_LANES 8
#include "chaplygin_sleigh.c"
#endif

const zd_direct zd_chaplygin_sleigh_direct[] = {
#if (ZD_SETS) & ZD_SET_BASELINE_1
    {0, 1, 2, orders_0_1},
#endif
#if (ZD_SETS) & ZD_SET_BASELINE_2
    {0, 2, 2, orders_0_2},
#endif
#if (ZD_SETS) & ZD_SET_AVX2_1
    {1, 1, 2, orders_1_1},
#endif
#if (ZD_SETS) & ZD_SET_AVX2_4
    {1, 4, 2, orders_1_4},
#endif
#if (ZD_SETS) & ZD_SET_AVX512_1
    {2, 1, 2, orders_2_1},
#endif
#if (ZD_SETS) & ZD_SET_AVX512_8
    {2, 8, 2, orders_2_8},
#endif
};

#else
#include "../../include/zerodrift/lanes.h"

ZD_ON_UNIT static int ZD_NAMED(accelerate_0)(const void *data, const double *at_time, const double *at_p,
    const double *at_v, const double *with_added, double *to_pdot, double *to_vdot, double *to_lambda,
    double *to_power, double *to_pivots)
{
    const zd_stored *restrict const k = (const zd_stored *)(data);
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
    const zd_real p2 = p[2];
    const zd_real v0 = v[0], v1 = v[1], v2 = v[2];
    const zd_real added0 = added ? (zd_real)added[0] : ZD_SPLAT(0.0);
    const zd_real x16 = v2 * v2;
    const zd_real angle3[ZD_PADDED(1)] = {p2};
    zd_real sine3[ZD_PADDED(1)], cosine3[ZD_PADDED(1)];
    ZD_SINES(1, angle3, sine3, cosine3);
    const zd_real x7 = sine3[0] * k[6];
    const zd_real x10 = k[6] * cosine3[0];
    const zd_real x19 = x7 * x16;
    const zd_real x29 = 1.0 / cosine3[0];
    const zd_real x30 = sine3[0] * x29;
    const zd_real x31 = k[0] * x30;
    const zd_real x33 = ZD_FMS(x10, x30, x7);
    const zd_real x36 = 1.0 / ZD_FMA(x30, x31, k[0]);
    const zd_real x38 = x33 * x36;
    const zd_real x39 = x33 * x38;
    const zd_real x40 = k[7] - x39;
    const zd_real x67 = x29 * ZD_FMA(v2, ZD_FMA(cosine3[0], v0, sine3[0] * v1), added0);
    const zd_real x74 = ZD_FNMA(x31, x67, ZD_FMA(x19, x30, x10 * x16));
    const zd_real x79 = (1.0 / x40) * ZD_FMA(x38, x74, x10 * x67);
    const zd_real x83 = ZD_FMA(x38, x79, x36 * x74);
    const zd_real x85 = ZD_FMA(x30, x83, x67);
    vdot[0] = x83;
    vdot[1] = x85;
    vdot[2] = -x79;
    if (lambda || power) {
        if (lambda) lambda[0] = x29 * (x19 - ZD_FNMA(x10, x79, k[0] * x85));
        if (power) power[0] = ZD_SPLAT(0.0);
    }
    if (pivots) {
        pivots[0] = cosine3[0];
        pivots[1] = ZD_SPLAT(1.0);
        pivots[2] = x40 / (x39 + x40);
    }
    return ZD_DONE;
}

ZD_ON_UNIT static int ZD_NAMED(correct_0)(const void *data, const double *at_time, const double *at_p,
    const double *at_v, double *to_Phi, double *to_dp, double *to_dv)
{
    const zd_stored *restrict const k = (const zd_stored *)(data);
    const zd_stored *restrict const time = (const zd_stored *)at_time;
    const zd_stored *restrict const p = (const zd_stored *)at_p;
    const zd_stored *restrict const v = (const zd_stored *)at_v;
    zd_stored *restrict const Phi = (zd_stored *)to_Phi;
    zd_stored *restrict const dp = (zd_stored *)to_dp;
    zd_stored *restrict const dv = (zd_stored *)to_dv;
    const zd_real t = *time;
    (void)t, (void)k, (void)time, (void)p, (void)v, (void)Phi, (void)dp, (void)dv;
    const zd_real p2 = p[2];
    const zd_real v0 = v[0], v1 = v[1];
    const zd_real angle3[ZD_PADDED(1)] = {p2};
    zd_real sine3[ZD_PADDED(1)], cosine3[ZD_PADDED(1)];
    ZD_SINES(1, angle3, sine3, cosine3);
    const zd_real x10 = k[6] * cosine3[0];
    const zd_real x29 = 1.0 / cosine3[0];
    const zd_real x30 = sine3[0] * x29;
    const zd_real x31 = k[0] * x30;
    const zd_real x33 = ZD_FNMA(sine3[0], k[6], x10 * x30);
    const zd_real x36 = 1.0 / ZD_FMA(x30, x31, k[0]);
    const zd_real x38 = x33 * x36;
    const zd_real x109 = x29 * ZD_FNMA(sine3[0], v0, cosine3[0] * v1);
    const zd_real x110 = x31 * x109;
    const zd_real x119 = (1.0 / ZD_FNMA(x33, x38, k[7])) * ZD_FNMA(x10, x109, x38 * x110);
    const zd_real x121 = ZD_FMA(x38, x119, x36 * x110);
    dp[0] = ZD_SPLAT(0.0);
    dp[1] = ZD_SPLAT(0.0);
    dp[2] = ZD_SPLAT(0.0);
    dv[0] = -x121;
    dv[1] = ZD_FNMA(x30, x121, x109);
    dv[2] = x119;
    return ZD_DONE;
}

#if ZD_LANES == 1
ZD_ON_UNIT static int ZD_NAMED(land_0)(const void *data, const double *at_time, const double *at_p,
    double *to_v, const double *where_allowed, double *to_Phi, double *to_dp, double *to_pdot, double *to_vdot,
    double *to_lambda, double *to_power, double *to_pivots)
{
    const zd_stored *restrict const k = (const zd_stored *)(data);
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
    const zd_real p2 = p[2];
    const zd_real before0 = v[0], before1 = v[1], before2 = v[2];
    const zd_real angle3[ZD_PADDED(1)] = {p2};
    zd_real sine3[ZD_PADDED(1)], cosine3[ZD_PADDED(1)];
    ZD_SINES(1, angle3, sine3, cosine3);
    const zd_real x7 = sine3[0] * k[6];
    const zd_real x10 = k[6] * cosine3[0];
    const zd_real x29 = 1.0 / cosine3[0];
    const zd_real x30 = sine3[0] * x29;
    const zd_real x31 = k[0] * x30;
    const zd_real x33 = ZD_FMS(x10, x30, x7);
    const zd_real x36 = 1.0 / ZD_FMA(x30, x31, k[0]);
    const zd_real x38 = x33 * x36;
    const zd_real x39 = x33 * x38;
    const zd_real x40 = k[7] - x39;
    const zd_real x41 = 1.0 / x40;
    const zd_real x133 = x29 * ZD_FNMA(sine3[0], before0, cosine3[0] * before1);
    const zd_real x134 = x31 * x133;
    const zd_real x143 = x41 * ZD_FNMA(x10, x133, x38 * x134);
    const zd_real x145 = ZD_FMA(x38, x143, x36 * x134);
    const zd_real v0 = before0 - (-x145);
    const zd_real v1 = before1 - ZD_FNMA(x30, x145, x133);
    const zd_real v2 = before2 - x143;
    const zd_real x16 = v2 * v2;
    const zd_real x19 = x7 * x16;
    const zd_real x150 = (v2 * ZD_FMA(cosine3[0], v0, sine3[0] * v1)) * x29;
    const zd_real x155 = ZD_FNMA(x31, x150, ZD_FMA(x19, x30, x10 * x16));
    const zd_real x160 = x41 * ZD_FMA(x38, x155, x10 * x150);
    const zd_real x164 = ZD_FMA(x38, x160, x36 * x155);
    const zd_real x166 = ZD_FMA(x30, x164, x150);
    v[0] = v0;
    v[1] = v1;
    v[2] = v2;
    vdot[0] = x164;
    vdot[1] = x166;
    vdot[2] = -x160;
    if (lambda || power) {
        if (lambda) lambda[0] = x29 * (x19 - ZD_FNMA(x10, x160, k[0] * x166));
        if (power) power[0] = ZD_SPLAT(0.0);
    }
    if (pivots) {
        pivots[0] = cosine3[0];
        pivots[1] = ZD_SPLAT(1.0);
        pivots[2] = x40 / (x39 + x40);
    }
    return ZD_DONE;
}
#endif

ZD_ON_UNIT static int ZD_NAMED(accelerate_1)(const void *data, const double *at_time, const double *at_p,
    const double *at_v, const double *with_added, double *to_pdot, double *to_vdot, double *to_lambda,
    double *to_power, double *to_pivots)
{
    const zd_stored *restrict const k = (const zd_stored *)(data);
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
    const zd_real p2 = p[2];
    const zd_real v0 = v[0], v1 = v[1], v2 = v[2];
    const zd_real added0 = added ? (zd_real)added[0] : ZD_SPLAT(0.0);
    const zd_real x16 = v2 * v2;
    const zd_real angle3[ZD_PADDED(1)] = {p2};
    zd_real sine3[ZD_PADDED(1)], cosine3[ZD_PADDED(1)];
    ZD_SINES(1, angle3, sine3, cosine3);
    const zd_real x7 = sine3[0] * k[6];
    const zd_real x10 = k[6] * cosine3[0];
    const zd_real x17 = x10 * x16;
    const zd_real x45 = 1.0 / sine3[0];
    const zd_real x48 = cosine3[0] * x45;
    const zd_real x50 = k[0] * x48;
    const zd_real x53 = ZD_FNMA(x7, x48, x10);
    const zd_real x56 = 1.0 / ZD_FMA(x48, x50, k[0]);
    const zd_real x58 = x53 * x56;
    const zd_real x59 = x53 * x58;
    const zd_real x60 = k[7] - x59;
    const zd_real x186 = x45 * ZD_FMA(v2, ZD_FMA(cosine3[0], v0, sine3[0] * v1), added0);
    const zd_real x194 = ZD_FMA(x50, x186, ZD_FMA(x17, x48, x7 * x16));
    const zd_real x199 = (1.0 / x60) * ZD_FMA(x58, x194, x7 * x186);
    const zd_real x203 = ZD_FMA(x58, x199, x56 * x194);
    const zd_real x205 = ZD_FMS(x48, x203, x186);
    vdot[0] = x205;
    vdot[1] = x203;
    vdot[2] = -x199;
    if (lambda || power) {
        if (lambda) lambda[0] = -(x45 * (x17 - ZD_FMA(x7, x199, k[0] * x205)));
        if (power) power[0] = ZD_SPLAT(0.0);
    }
    if (pivots) {
        pivots[0] = -sine3[0];
        pivots[1] = ZD_SPLAT(1.0);
        pivots[2] = x60 / (x59 + x60);
    }
    return ZD_DONE;
}

ZD_ON_UNIT static int ZD_NAMED(correct_1)(const void *data, const double *at_time, const double *at_p,
    const double *at_v, double *to_Phi, double *to_dp, double *to_dv)
{
    const zd_stored *restrict const k = (const zd_stored *)(data);
    const zd_stored *restrict const time = (const zd_stored *)at_time;
    const zd_stored *restrict const p = (const zd_stored *)at_p;
    const zd_stored *restrict const v = (const zd_stored *)at_v;
    zd_stored *restrict const Phi = (zd_stored *)to_Phi;
    zd_stored *restrict const dp = (zd_stored *)to_dp;
    zd_stored *restrict const dv = (zd_stored *)to_dv;
    const zd_real t = *time;
    (void)t, (void)k, (void)time, (void)p, (void)v, (void)Phi, (void)dp, (void)dv;
    const zd_real p2 = p[2];
    const zd_real v0 = v[0], v1 = v[1];
    const zd_real angle3[ZD_PADDED(1)] = {p2};
    zd_real sine3[ZD_PADDED(1)], cosine3[ZD_PADDED(1)];
    ZD_SINES(1, angle3, sine3, cosine3);
    const zd_real x7 = sine3[0] * k[6];
    const zd_real x45 = 1.0 / sine3[0];
    const zd_real x48 = cosine3[0] * x45;
    const zd_real x50 = k[0] * x48;
    const zd_real x53 = ZD_FNMA(x7, x48, k[6] * cosine3[0]);
    const zd_real x56 = 1.0 / ZD_FMA(x48, x50, k[0]);
    const zd_real x58 = x53 * x56;
    const zd_real x226 = x45 * ZD_FNMA(sine3[0], v0, cosine3[0] * v1);
    const zd_real x228 = x50 * x226;
    const zd_real x236 = (1.0 / ZD_FNMA(x53, x58, k[7])) * ZD_FMA(x58, x228, x7 * x226);
    const zd_real x240 = ZD_FMA(x58, x236, x56 * x228);
    dp[0] = ZD_SPLAT(0.0);
    dp[1] = ZD_SPLAT(0.0);
    dp[2] = ZD_SPLAT(0.0);
    dv[0] = ZD_FMS(x48, x240, x226);
    dv[1] = x240;
    dv[2] = -x236;
    return ZD_DONE;
}

#if ZD_LANES == 1
ZD_ON_UNIT static int ZD_NAMED(land_1)(const void *data, const double *at_time, const double *at_p,
    double *to_v, const double *where_allowed, double *to_Phi, double *to_dp, double *to_pdot, double *to_vdot,
    double *to_lambda, double *to_power, double *to_pivots)
{
    const zd_stored *restrict const k = (const zd_stored *)(data);
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
    const zd_real p2 = p[2];
    const zd_real before0 = v[0], before1 = v[1], before2 = v[2];
    const zd_real angle3[ZD_PADDED(1)] = {p2};
    zd_real sine3[ZD_PADDED(1)], cosine3[ZD_PADDED(1)];
    ZD_SINES(1, angle3, sine3, cosine3);
    const zd_real x7 = sine3[0] * k[6];
    const zd_real x10 = k[6] * cosine3[0];
    const zd_real x45 = 1.0 / sine3[0];
    const zd_real x48 = cosine3[0] * x45;
    const zd_real x50 = k[0] * x48;
    const zd_real x53 = ZD_FNMA(x7, x48, x10);
    const zd_real x56 = 1.0 / ZD_FMA(x48, x50, k[0]);
    const zd_real x58 = x53 * x56;
    const zd_real x59 = x53 * x58;
    const zd_real x60 = k[7] - x59;
    const zd_real x61 = 1.0 / x60;
    const zd_real x243 = x45 * ZD_FNMA(sine3[0], before0, cosine3[0] * before1);
    const zd_real x245 = x50 * x243;
    const zd_real x253 = x61 * ZD_FMA(x58, x245, x7 * x243);
    const zd_real x257 = ZD_FMA(x58, x253, x56 * x245);
    const zd_real v0 = before0 - ZD_FMS(x48, x257, x243);
    const zd_real v1 = before1 - x257;
    const zd_real v2 = before2 - (-x253);
    const zd_real x16 = v2 * v2;
    const zd_real x17 = x10 * x16;
    const zd_real x260 = (v2 * ZD_FMA(cosine3[0], v0, sine3[0] * v1)) * x45;
    const zd_real x266 = ZD_FMA(x50, x260, ZD_FMA(x17, x48, x7 * x16));
    const zd_real x271 = x61 * ZD_FMA(x58, x266, x7 * x260);
    const zd_real x275 = ZD_FMA(x58, x271, x56 * x266);
    const zd_real x277 = ZD_FMS(x48, x275, x260);
    v[0] = v0;
    v[1] = v1;
    v[2] = v2;
    vdot[0] = x277;
    vdot[1] = x275;
    vdot[2] = -x271;
    if (lambda || power) {
        if (lambda) lambda[0] = -(x45 * (x17 - ZD_FMA(x7, x271, k[0] * x277)));
        if (power) power[0] = ZD_SPLAT(0.0);
    }
    if (pivots) {
        pivots[0] = -sine3[0];
        pivots[1] = ZD_SPLAT(1.0);
        pivots[2] = x60 / (x59 + x60);
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
    {1, solve_0, row_0, column_0, ZD_NAMED(accelerate_0), ZD_NAMED(correct_0), ZD_LANDING(land_0)},
    {1, solve_1, row_1, column_1, ZD_NAMED(accelerate_1), ZD_NAMED(correct_1), ZD_LANDING(land_1)},
};
#undef ZD_LANDING

#undef ZD_UNIT
#undef ZD_LANES
#endif
