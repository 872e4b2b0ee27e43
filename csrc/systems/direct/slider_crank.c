/* Written by tests/direct_sources.py with SymPy 1.14.0, from tests/symbolic_counterparts.py. */
#ifndef ZD_LANES
#include "slider_crank.h"

#include <math.h>
#include "../../include/zerodrift/units.h"

/* What follows from the parameters alone, behind them. */
void zd_slider_crank_direct_constants(double *k)
{
    k[11] = 0.5 * k[5];
    k[12] = k[1] * k[8];
}

static const int solve_0[] = {0, 1};
static const int row_0[] = {0, 1};
static const int column_0[] = {1, 2};

/* The functions below, for each vector unit. */
#if (ZD_SETS) & ZD_SET_BASELINE_1
#define ZD_UNIT 0
#define ZD_LANES 1
#include "slider_crank.c"
#endif
#if (ZD_SETS) & ZD_SET_BASELINE_2
#define ZD_UNIT 0
#define ZD_LANES 2
#include "slider_crank.c"
#endif
#if (ZD_SETS) & ZD_SET_AVX2_1
#define ZD_UNIT 1
#define ZD_LANES 1
#include "slider_crank.c"
#endif
#if (ZD_SETS) & ZD_SET_AVX2_4
#define ZD_UNIT 1
#define ZD_LANES 4
#include "slider_crank.c"
#endif
#if (ZD_SETS) & ZD_SET_AVX512_1
#define ZD_UNIT 2
#define ZD_LANES 1
#include "slider_crank.c"
#endif
#if (ZD_SETS) & ZD_SET_AVX512_8
#define ZD_UNIT 2
#define ZD_LANES 8
#include "slider_crank.c"
#endif

const zd_direct zd_slider_crank_direct[] = {
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
    const zd_real p0 = p[0], p1 = p[1], p2 = p[2];
    const zd_real v0 = v[0], v1 = v[1], v2 = v[2];
    const zd_real added0 = added ? (zd_real)added[0] : ZD_SPLAT(0.0), added1 = added ? (zd_real)added[1] : ZD_SPLAT(0.0);
    const zd_real x94 = v0 * v0;
    const zd_real x96 = v2 * v2;
    const zd_real angle5[ZD_PADDED(2)] = {p0, p2};
    zd_real sine5[ZD_PADDED(2)], cosine5[ZD_PADDED(2)];
    ZD_SINES(2, angle5, sine5, cosine5);
    const zd_real x8 = sine5[0] * k[0];
    const zd_real x12 = sine5[1] * k[1];
    const zd_real x16 = -((x8 + x12) * 0.5);
    const zd_real x19 = k[0] * cosine5[0];
    const zd_real x21 = k[1] * cosine5[1];
    const zd_real x22 = x19 + x21;
    const zd_real x25 = ZD_FNMA(0.5, x22, p1);
    const zd_real x27 = ZD_FMA(x25, x25, x16 * x16);
    const zd_real x44 = 0.5 * ZD_FMA(x25, ZD_FMA(x12, v2, ZD_FMA(x8, v0, v1 * 2.0)), x16 * (-ZD_FMA(x21, v2, x19 * v0)));
    const zd_real x48 = k[0] * ZD_FNMA(x16, cosine5[0], sine5[0] * x25);
    const zd_real x49 = 0.5 * x48;
    const zd_real x54 = ZD_SQRT(x27);
    const zd_real x56 = x54 - k[7];
    const zd_real x70 = x56 * k[11];
    const zd_real x74 = (k[8] - ((ZD_FMS(p1, 2.0, x22) * x70) / x54)) - ((x44 * (x25 * k[6])) / x27);
    const zd_real x78 = k[1] * ZD_FNMA(x16, cosine5[1], sine5[1] * x25);
    const zd_real x79 = 0.5 * x78;
    const zd_real x88 = ((x44 * (k[6] * x79)) / x27) + ZD_FMA(sine5[1], k[12], (x70 * x78) / x54);
    const zd_real x119 = 1.0 / x21;
    const zd_real x121 = x19 * x119;
    const zd_real x125 = ZD_FNMA(x12, x121, x8);
    const zd_real x127 = k[3] * x125;
    const zd_real x129 = k[4] * x121;
    const zd_real x143 = x119 * (added1 - ZD_FMA(x12, x96, x8 * x94));
    const zd_real x147 = ZD_FMA(x12, x143, added0 - ZD_FMA(x21, x96, x19 * x94));
    const zd_real x161 = ZD_FMS(x88, x121, ZD_FMA(x74, x125, ((x44 * (x49 * k[6])) / x27) + ((x56 * (x48 * k[11])) / x54))) - ZD_FNMA(x127, x147, x129 * x143);
    const zd_real x162 = (1.0 / ZD_FMA(x121, x129, ZD_FMA(x125, x127, k[2]))) * x161;
    const zd_real x165 = ZD_FNMA(x125, x162, x147);
    const zd_real x168 = ZD_FMA(x121, x162, x143);
    vdot[0] = x162;
    vdot[1] = x165;
    vdot[2] = -x168;
    if (lambda || power) {
        const zd_real x174 = ZD_FNMA(k[3], x165, x74);
        if (lambda) lambda[0] = x174;
        if (lambda) lambda[1] = -(x119 * ZD_FNMA(x12, x174, ZD_FMS(k[4], x168, x88)));
        if (power) power[0] = -(x44 * ((k[6] * ZD_FMA(v2, x79, ZD_FMA(x25, v1, v0 * x49))) / x27));
    }
    if (pivots) {
        pivots[0] = ZD_SPLAT(1.0);
        pivots[1] = -x21;
        pivots[2] = ZD_SPLAT(1.0);
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
    const zd_real p0 = p[0], p1 = p[1], p2 = p[2];
    const zd_real v0 = v[0], v1 = v[1], v2 = v[2];
    const zd_real angle5[ZD_PADDED(2)] = {p0, p2};
    zd_real sine5[ZD_PADDED(2)], cosine5[ZD_PADDED(2)];
    ZD_SINES(2, angle5, sine5, cosine5);
    const zd_real x8 = sine5[0] * k[0];
    const zd_real x12 = sine5[1] * k[1];
    const zd_real x13 = x8 + x12;
    const zd_real x19 = k[0] * cosine5[0];
    const zd_real x21 = k[1] * cosine5[1];
    const zd_real x90 = p1 - (x19 + x21);
    const zd_real x119 = 1.0 / x21;
    const zd_real x121 = x19 * x119;
    const zd_real x125 = ZD_FNMA(x12, x121, x8);
    const zd_real x127 = k[3] * x125;
    const zd_real x129 = k[4] * x121;
    const zd_real x137 = 1.0 / ZD_FMA(x121, x129, ZD_FMA(x125, x127, k[2]));
    const zd_real x186 = x13 * x119;
    const zd_real x189 = ZD_FNMA(x12, x186, x90);
    const zd_real x196 = x137 * ZD_FMA(x129, x186, x127 * x189);
    const zd_real x203 = ZD_FMA(x21, v2, x19 * v0) * x119;
    const zd_real x206 = ZD_FNMA(x12, x203, ZD_FMA(x12, v2, ZD_FMA(x8, v0, v1)));
    const zd_real x213 = x137 * ZD_FMA(x129, x203, x127 * x206);
    Phi[0] = x90;
    Phi[1] = -x13;
    dp[0] = x196;
    dp[1] = ZD_FNMA(x125, x196, x189);
    dp[2] = ZD_FNMA(x121, x196, x186);
    dv[0] = x213;
    dv[1] = ZD_FNMA(x125, x213, x206);
    dv[2] = ZD_FNMA(x121, x213, x203);
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
    const zd_real p0 = p[0], p1 = p[1], p2 = p[2];
    const zd_real before0 = v[0], before1 = v[1], before2 = v[2];
    const zd_real angle5[ZD_PADDED(2)] = {p0, p2};
    zd_real sine5[ZD_PADDED(2)], cosine5[ZD_PADDED(2)];
    ZD_SINES(2, angle5, sine5, cosine5);
    const zd_real x8 = sine5[0] * k[0];
    const zd_real x12 = sine5[1] * k[1];
    const zd_real x13 = x8 + x12;
    const zd_real x19 = k[0] * cosine5[0];
    const zd_real x21 = k[1] * cosine5[1];
    const zd_real x22 = x19 + x21;
    const zd_real x90 = p1 - x22;
    Phi[0] = x90;
    Phi[1] = -x13;
    if (!(fabs(Phi[0]) <= allowed[0]) || !(fabs(Phi[1]) <= allowed[1])) {
        const zd_real x119 = 1.0 / x21;
        const zd_real x121 = x19 * x119;
        const zd_real x125 = ZD_FNMA(x12, x121, x8);
        const zd_real x127 = k[3] * x125;
        const zd_real x129 = k[4] * x121;
        const zd_real x137 = 1.0 / ZD_FMA(x121, x129, ZD_FMA(x125, x127, k[2]));
        const zd_real x186 = x13 * x119;
        const zd_real x189 = ZD_FNMA(x12, x186, x90);
        const zd_real x196 = x137 * ZD_FMA(x129, x186, x127 * x189);
        dp[0] = x196;
        dp[1] = ZD_FNMA(x125, x196, x189);
        dp[2] = ZD_FNMA(x121, x196, x186);
        return ZD_NO_CONVERGENCE;
    }
    const zd_real x119 = 1.0 / x21;
    const zd_real x121 = x19 * x119;
    const zd_real x125 = ZD_FNMA(x12, x121, x8);
    const zd_real x127 = k[3] * x125;
    const zd_real x129 = k[4] * x121;
    const zd_real x137 = 1.0 / ZD_FMA(x121, x129, ZD_FMA(x125, x127, k[2]));
    const zd_real x233 = x119 * ZD_FMA(x21, before2, x19 * before0);
    const zd_real x236 = ZD_FNMA(x12, x233, ZD_FMA(x12, before2, ZD_FMA(x8, before0, before1)));
    const zd_real x243 = x137 * ZD_FMA(x129, x233, x127 * x236);
    const zd_real v0 = before0 - x243;
    const zd_real v1 = before1 - ZD_FNMA(x125, x243, x236);
    const zd_real v2 = before2 - ZD_FNMA(x121, x243, x233);
    const zd_real x16 = -(x13 * 0.5);
    const zd_real x25 = ZD_FNMA(0.5, x22, p1);
    const zd_real x27 = ZD_FMA(x25, x25, x16 * x16);
    const zd_real x44 = 0.5 * ZD_FMA(x25, ZD_FMA(x12, v2, ZD_FMA(x8, v0, v1 * 2.0)), x16 * (-ZD_FMA(x21, v2, x19 * v0)));
    const zd_real x48 = k[0] * ZD_FNMA(x16, cosine5[0], sine5[0] * x25);
    const zd_real x49 = 0.5 * x48;
    const zd_real x54 = ZD_SQRT(x27);
    const zd_real x56 = x54 - k[7];
    const zd_real x70 = x56 * k[11];
    const zd_real x74 = (k[8] - ((ZD_FMS(p1, 2.0, x22) * x70) / x54)) - ((x44 * (x25 * k[6])) / x27);
    const zd_real x78 = k[1] * ZD_FNMA(x16, cosine5[1], sine5[1] * x25);
    const zd_real x79 = 0.5 * x78;
    const zd_real x88 = ((x44 * (k[6] * x79)) / x27) + ZD_FMA(sine5[1], k[12], (x70 * x78) / x54);
    const zd_real x94 = v0 * v0;
    const zd_real x96 = v2 * v2;
    const zd_real x250 = ZD_FMA(x12, x96, x8 * x94) * x119;
    const zd_real x253 = ZD_FMA(x12, x250, ZD_FMA(x21, x96, x19 * x94));
    const zd_real x261 = ZD_FMS(x88, x121, ZD_FMA(x74, x125, ((x44 * (x49 * k[6])) / x27) + ((x56 * (x48 * k[11])) / x54))) - ZD_FNMA(x129, x250, x127 * x253);
    const zd_real x262 = x137 * x261;
    const zd_real x265 = ZD_FMA(x125, x262, x253);
    const zd_real x269 = ZD_FNMA(x121, x262, x250);
    v[0] = v0;
    v[1] = v1;
    v[2] = v2;
    vdot[0] = x262;
    vdot[1] = -x265;
    vdot[2] = x269;
    if (lambda || power) {
        const zd_real x275 = ZD_FMA(k[3], x265, x74);
        if (lambda) lambda[0] = x275;
        if (lambda) lambda[1] = x119 * ZD_FMA(x12, x275, ZD_FMA(k[4], x269, x88));
        if (power) power[0] = -(x44 * ((k[6] * ZD_FMA(v2, x79, ZD_FMA(x25, v1, v0 * x49))) / x27));
    }
    if (pivots) {
        pivots[0] = ZD_SPLAT(1.0);
        pivots[1] = -x21;
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
