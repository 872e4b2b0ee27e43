/* Written by tests/direct_sources.py with SymPy 1.14.0, from tests/symbolic_counterparts.py. */
#ifndef ZD_LANES
#include "four_bar.h"

#include <math.h>
#include "../../include/zerodrift/units.h"

/* What follows from the parameters alone, behind them. */
void zd_four_bar_direct_constants(double *k)
{
    k[11] = k[7] + ((k[1] * k[1]) * (k[6] + ((k[4] * 0.25) + k[5])));
    const double x32 = k[6] + (k[5] * 0.5);
    k[12] = x32 * (k[1] * k[2]);
    k[13] = k[3] * (k[1] * k[6]);
    k[14] = 0.5 * k[13];
    k[15] = k[8] + ((k[2] * k[2]) * (k[6] + (0.25 * k[5])));
    k[16] = k[3] * (k[6] * k[2]);
    k[17] = 0.5 * k[16];
    k[18] = k[9] + ((k[3] * k[3]) * (k[6] * 0.25));
    k[19] = ((k[4] * 0.5) + (k[6] + k[5])) * (k[1] * k[10]);
    k[20] = k[10] * (x32 * k[2]);
    k[21] = 0.5 * (k[10] * (k[6] * k[3]));
}

static const int solve_0[] = {0, 0};
static const int row_0[] = {0, 1};
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
    const zd_real x86 = v0 - v1;
    const zd_real x89 = v0 - v2;
    const zd_real x92 = v1 - v2;
    const zd_real x146 = v2 * v2;
    const zd_real x148 = v0 * v0;
    const zd_real x150 = v1 * v1;
    const zd_real angle16[ZD_PADDED(3)] = {p1, p0, p2};
    zd_real sine16[ZD_PADDED(3)], cosine16[ZD_PADDED(3)];
    ZD_SINES(3, angle16, sine16, cosine16);
    const zd_real x25 = ZD_FNMA(sine16[0], cosine16[1], cosine16[0] * sine16[1]);
    const zd_real x36 = ZD_FMA(sine16[0], sine16[1], cosine16[0] * cosine16[1]) * k[12];
    const zd_real x44 = ZD_FNMA(cosine16[1], sine16[2], sine16[1] * cosine16[2]);
    const zd_real x53 = ZD_FMA(sine16[1], sine16[2], cosine16[1] * cosine16[2]) * k[14];
    const zd_real x63 = ZD_FNMA(cosine16[0], sine16[2], sine16[0] * cosine16[2]);
    const zd_real x71 = ZD_FMA(sine16[0], sine16[2], cosine16[0] * cosine16[2]) * k[17];
    const zd_real x79 = v1 * (x25 * k[12]);
    const zd_real x82 = v2 * (x44 * k[14]);
    const zd_real x131 = cosine16[2] * k[3];
    const zd_real x132 = cosine16[0] * k[2];
    const zd_real x133 = k[1] * cosine16[1];
    const zd_real x138 = sine16[2] * k[3];
    const zd_real x139 = k[1] * sine16[1];
    const zd_real x140 = sine16[0] * k[2];
    const zd_real x164 = ZD_FNMA(x131, x140, x132 * x138);
    const zd_real x202 = ZD_FNMA(x133, x138, x131 * x139);
    const zd_real x207 = ZD_FNMA(x132, x139, x133 * x140);
    const zd_real x217 = ZD_FMA(x71, x207, ZD_FMA(k[15], x202, x36 * x164));
    const zd_real x222 = ZD_FMA(k[18], x207, ZD_FMA(x71, x202, x53 * x164));
    const zd_real x227 = ZD_FMA(x207, x222, ZD_FMA(x202, x217, x164 * ZD_FMA(x53, x207, ZD_FMA(x36, x202, k[11] * x164))));
    const zd_real x229 = 1.0 / (x164 * x227);
    const zd_real x230 = x227 * x229;
    const zd_real x234 = ZD_FMA(x131, x146, ZD_FMA(x132, x150, x133 * x148)) + added0;
    const zd_real x235 = ZD_FMA(x138, x146, ZD_FMA(x140, x150, x139 * x148)) + added1;
    const zd_real x238 = ZD_FMA(cosine16[0], k[20], ZD_FNMA(v0, x25 * (k[12] * (v1 + x86)), v2 * (x63 * (0.5 * (k[16] * (v1 - x92))))));
    const zd_real x240 = ZD_FNMA(cosine16[2], k[21], 0.5 * ZD_FMA(v1, x63 * (k[16] * (v2 + x92)), v0 * (x44 * (k[13] * (v2 + x89)))));
    const zd_real x243 = ZD_FMA(x138, x235, x131 * x234);
    const zd_real x248 = ZD_FMA(x140, x235, x132 * x234);
    const zd_real x260 = ZD_FMA(x202, x238, x164 * ZD_FMA(cosine16[1], k[19], ZD_FNMA(x82, x89, ZD_FNMA(x79, x86, (x79 + x82) * v0))));
    const zd_real x265 = (x164 * x229) * ZD_FMS(x164, ZD_FMS(x207, x240, x260), ZD_FNMA(x222, x248, x217 * x243));
    const zd_real x271 = ZD_FMA(x265, x202 * x230, x230 * x243);
    const zd_real x276 = ZD_FNMA(x230, x248, x265 * (x207 * x230));
    vdot[0] = x265;
    vdot[1] = x271;
    vdot[2] = x276;
    if (lambda || power) {
        const zd_real x289 = x238 + ZD_FMA(x71, x276, ZD_FMA(k[15], x271, x36 * x265));
        const zd_real x296 = x240 - ZD_FMA(k[18], x276, ZD_FMA(x71, x271, x53 * x265));
        if (lambda) lambda[0] = -(x230 * ZD_FMA(x132, x296, x131 * x289));
        if (lambda) lambda[1] = -(x230 * ZD_FMA(x140, x296, x138 * x289));
        if (power) power[0] = ZD_SPLAT(0.0);
    }
    if (pivots) {
        pivots[0] = x164;
        pivots[1] = ZD_SPLAT(1.0);
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
    const zd_real angle16[ZD_PADDED(3)] = {p1, p0, p2};
    zd_real sine16[ZD_PADDED(3)], cosine16[ZD_PADDED(3)];
    ZD_SINES(3, angle16, sine16, cosine16);
    const zd_real x36 = ZD_FMA(sine16[0], sine16[1], cosine16[0] * cosine16[1]) * k[12];
    const zd_real x53 = ZD_FMA(sine16[1], sine16[2], cosine16[1] * cosine16[2]) * k[14];
    const zd_real x71 = ZD_FMA(sine16[0], sine16[2], cosine16[0] * cosine16[2]) * k[17];
    const zd_real x131 = cosine16[2] * k[3];
    const zd_real x132 = cosine16[0] * k[2];
    const zd_real x133 = k[1] * cosine16[1];
    const zd_real x137 = x131 + (x132 + (x133 - k[0]));
    const zd_real x138 = sine16[2] * k[3];
    const zd_real x139 = k[1] * sine16[1];
    const zd_real x140 = sine16[0] * k[2];
    const zd_real x142 = x138 + (x139 + x140);
    const zd_real x164 = ZD_FNMA(x131, x140, x132 * x138);
    const zd_real x202 = ZD_FNMA(x133, x138, x131 * x139);
    const zd_real x207 = ZD_FNMA(x132, x139, x133 * x140);
    const zd_real x217 = ZD_FMA(x71, x207, ZD_FMA(k[15], x202, x36 * x164));
    const zd_real x222 = ZD_FMA(k[18], x207, ZD_FMA(x71, x202, x53 * x164));
    const zd_real x227 = ZD_FMA(x207, x222, ZD_FMA(x202, x217, x164 * ZD_FMA(x53, x207, ZD_FMA(x36, x202, k[11] * x164))));
    const zd_real x229 = 1.0 / (x164 * x227);
    const zd_real x230 = x227 * x229;
    const zd_real x231 = x164 * x229;
    const zd_real x269 = x202 * x230;
    const zd_real x274 = x207 * x230;
    const zd_real x321 = ZD_FMA(v2, x138, ZD_FMA(v1, x140, v0 * x139));
    const zd_real x327 = ZD_FMA(v2, x131, ZD_FMA(v1, x132, v0 * x133));
    const zd_real x330 = ZD_FMA(x138, x142, x131 * x137);
    const zd_real x335 = ZD_FMA(x140, x142, x132 * x137);
    const zd_real x342 = x231 * ZD_FNMA(x222, x335, x217 * x330);
    const zd_real x359 = ZD_FNMA(x131, x321, x138 * x327);
    const zd_real x364 = ZD_FNMA(x140, x327, x132 * x321);
    const zd_real x369 = x231 * ZD_FMA(x222, x364, x217 * x359);
    Phi[0] = x137;
    Phi[1] = x142;
    dp[0] = -x342;
    dp[1] = ZD_FNMA(x269, x342, x230 * x330);
    dp[2] = -ZD_FMA(x274, x342, x230 * x335);
    dv[0] = -x369;
    dv[1] = ZD_FNMA(x269, x369, x230 * x359);
    dv[2] = ZD_FNMA(x274, x369, x230 * x364);
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
    const zd_real angle16[ZD_PADDED(3)] = {p1, p0, p2};
    zd_real sine16[ZD_PADDED(3)], cosine16[ZD_PADDED(3)];
    ZD_SINES(3, angle16, sine16, cosine16);
    const zd_real x131 = cosine16[2] * k[3];
    const zd_real x132 = cosine16[0] * k[2];
    const zd_real x133 = k[1] * cosine16[1];
    const zd_real x137 = x131 + (x132 + (x133 - k[0]));
    const zd_real x138 = sine16[2] * k[3];
    const zd_real x139 = k[1] * sine16[1];
    const zd_real x140 = sine16[0] * k[2];
    const zd_real x142 = x138 + (x139 + x140);
    Phi[0] = x137;
    Phi[1] = x142;
    if (!(fabs(Phi[0]) <= allowed[0]) || !(fabs(Phi[1]) <= allowed[1])) {
        const zd_real x36 = ZD_FMA(sine16[0], sine16[1], cosine16[0] * cosine16[1]) * k[12];
        const zd_real x53 = ZD_FMA(sine16[1], sine16[2], cosine16[1] * cosine16[2]) * k[14];
        const zd_real x71 = ZD_FMA(sine16[0], sine16[2], cosine16[0] * cosine16[2]) * k[17];
        const zd_real x164 = ZD_FNMA(x131, x140, x132 * x138);
        const zd_real x202 = ZD_FNMA(x133, x138, x131 * x139);
        const zd_real x207 = ZD_FNMA(x132, x139, x133 * x140);
        const zd_real x217 = ZD_FMA(x71, x207, ZD_FMA(k[15], x202, x36 * x164));
        const zd_real x222 = ZD_FMA(k[18], x207, ZD_FMA(x71, x202, x53 * x164));
        const zd_real x227 = ZD_FMA(x207, x222, ZD_FMA(x202, x217, x164 * ZD_FMA(x53, x207, ZD_FMA(x36, x202, k[11] * x164))));
        const zd_real x229 = 1.0 / (x164 * x227);
        const zd_real x230 = x227 * x229;
        const zd_real x231 = x164 * x229;
        const zd_real x269 = x202 * x230;
        const zd_real x274 = x207 * x230;
        const zd_real x330 = ZD_FMA(x138, x142, x131 * x137);
        const zd_real x335 = ZD_FMA(x140, x142, x132 * x137);
        const zd_real x342 = x231 * ZD_FNMA(x222, x335, x217 * x330);
        dp[0] = -x342;
        dp[1] = ZD_FNMA(x269, x342, x230 * x330);
        dp[2] = -ZD_FMA(x274, x342, x230 * x335);
        return ZD_NO_CONVERGENCE;
    }
    const zd_real x36 = ZD_FMA(sine16[0], sine16[1], cosine16[0] * cosine16[1]) * k[12];
    const zd_real x53 = ZD_FMA(sine16[1], sine16[2], cosine16[1] * cosine16[2]) * k[14];
    const zd_real x71 = ZD_FMA(sine16[0], sine16[2], cosine16[0] * cosine16[2]) * k[17];
    const zd_real x164 = ZD_FNMA(x131, x140, x132 * x138);
    const zd_real x202 = ZD_FNMA(x133, x138, x131 * x139);
    const zd_real x207 = ZD_FNMA(x132, x139, x133 * x140);
    const zd_real x217 = ZD_FMA(x71, x207, ZD_FMA(k[15], x202, x36 * x164));
    const zd_real x222 = ZD_FMA(k[18], x207, ZD_FMA(x71, x202, x53 * x164));
    const zd_real x227 = ZD_FMA(x207, x222, ZD_FMA(x202, x217, x164 * ZD_FMA(x53, x207, ZD_FMA(x36, x202, k[11] * x164))));
    const zd_real x229 = 1.0 / (x164 * x227);
    const zd_real x230 = x227 * x229;
    const zd_real x231 = x164 * x229;
    const zd_real x269 = x202 * x230;
    const zd_real x274 = x207 * x230;
    const zd_real x392 = ZD_FMA(x138, before2, ZD_FMA(x140, before1, x139 * before0));
    const zd_real x398 = ZD_FMA(x131, before2, ZD_FMA(x132, before1, x133 * before0));
    const zd_real x402 = ZD_FNMA(x131, x392, x138 * x398);
    const zd_real x407 = ZD_FNMA(x140, x398, x132 * x392);
    const zd_real x412 = x231 * ZD_FMA(x222, x407, x217 * x402);
    const zd_real v0 = before0 - (-x412);
    const zd_real v1 = before1 - ZD_FNMA(x269, x412, x230 * x402);
    const zd_real v2 = before2 - ZD_FNMA(x274, x412, x230 * x407);
    const zd_real x25 = ZD_FNMA(sine16[0], cosine16[1], cosine16[0] * sine16[1]);
    const zd_real x44 = ZD_FNMA(cosine16[1], sine16[2], sine16[1] * cosine16[2]);
    const zd_real x63 = ZD_FNMA(cosine16[0], sine16[2], sine16[0] * cosine16[2]);
    const zd_real x79 = v1 * (x25 * k[12]);
    const zd_real x82 = v2 * (x44 * k[14]);
    const zd_real x86 = v0 - v1;
    const zd_real x89 = v0 - v2;
    const zd_real x92 = v1 - v2;
    const zd_real x146 = v2 * v2;
    const zd_real x148 = v0 * v0;
    const zd_real x150 = v1 * v1;
    const zd_real x153 = ZD_FMA(x131, x146, ZD_FMA(x132, x150, x133 * x148));
    const zd_real x158 = ZD_FMA(x138, x146, ZD_FMA(x140, x150, x139 * x148));
    const zd_real x238 = ZD_FMA(cosine16[0], k[20], ZD_FNMA(v0, x25 * (k[12] * (v1 + x86)), v2 * (x63 * (0.5 * (k[16] * (v1 - x92))))));
    const zd_real x240 = ZD_FNMA(cosine16[2], k[21], 0.5 * ZD_FMA(v1, x63 * (k[16] * (v2 + x92)), v0 * (x44 * (k[13] * (v2 + x89)))));
    const zd_real x260 = ZD_FMA(x202, x238, x164 * ZD_FMA(cosine16[1], k[19], ZD_FNMA(x82, x89, ZD_FNMA(x79, x86, (x79 + x82) * v0))));
    const zd_real x426 = ZD_FMA(x138, x158, x131 * x153);
    const zd_real x431 = ZD_FMA(x140, x158, x132 * x153);
    const zd_real x439 = x231 * ZD_FMS(x164, ZD_FMS(x207, x240, x260), ZD_FNMA(x222, x431, x217 * x426));
    const zd_real x443 = ZD_FMA(x269, x439, x230 * x426);
    const zd_real x447 = ZD_FNMA(x230, x431, x274 * x439);
    v[0] = v0;
    v[1] = v1;
    v[2] = v2;
    vdot[0] = x439;
    vdot[1] = x443;
    vdot[2] = x447;
    if (lambda || power) {
        const zd_real x460 = x238 + ZD_FMA(x71, x447, ZD_FMA(k[15], x443, x36 * x439));
        const zd_real x467 = x240 - ZD_FMA(k[18], x447, ZD_FMA(x71, x443, x53 * x439));
        if (lambda) lambda[0] = -(x230 * ZD_FMA(x132, x467, x131 * x460));
        if (lambda) lambda[1] = -(x230 * ZD_FMA(x140, x467, x138 * x460));
        if (power) power[0] = ZD_SPLAT(0.0);
    }
    if (pivots) {
        pivots[0] = x164;
        pivots[1] = ZD_SPLAT(1.0);
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
};
#undef ZD_LANDING

#undef ZD_UNIT
#undef ZD_LANES
#endif
