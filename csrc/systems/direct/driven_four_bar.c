/* Written by tests/direct_sources.py with SymPy 1.14.0, from tests/symbolic_counterparts.py. */
#ifndef ZD_LANES
#include "driven_four_bar.h"

#include <math.h>
#include "../../include/zerodrift/units.h"

/* What follows from the parameters alone, behind them. */
void zd_driven_four_bar_direct_constants(double *k)
{
    k[15] = k[7] + ((k[1] * k[1]) * (k[6] + ((k[4] * 0.25) + k[5])));
    const double x32 = k[6] + (k[5] * 0.5);
    k[16] = x32 * (k[1] * k[2]);
    k[17] = k[3] * (k[1] * k[6]);
    k[18] = 0.5 * k[17];
    k[19] = k[8] + ((k[2] * k[2]) * (k[6] + (0.25 * k[5])));
    k[20] = k[3] * (k[6] * k[2]);
    k[21] = 0.5 * k[20];
    k[22] = k[9] + ((k[3] * k[3]) * (k[6] * 0.25));
    k[23] = ((k[4] * 0.5) + (k[6] + k[5])) * (k[1] * k[10]);
    k[24] = k[10] * (x32 * k[2]);
    k[25] = 0.5 * (k[10] * (k[6] * k[3]));
    k[26] = k[14] * k[13];
    k[27] = k[13] * (k[14] * k[14]);
}

static const int solve_0[] = {0, 1, 1};
static const int row_0[] = {2, 0, 1};
static const int column_0[] = {0, 1, 2};

/* The functions below, for each vector unit. */
#if (ZD_SETS) & ZD_SET_BASELINE_1
#define ZD_UNIT 0
#define ZD_LANES 1
#include "driven_four_bar.c"
#endif
#if (ZD_SETS) & ZD_SET_BASELINE_2
#define ZD_UNIT 0
#define ZD_LANES 2
#include "driven_four_bar.c"
#endif
#if (ZD_SETS) & ZD_SET_AVX2_1
#define ZD_UNIT 1
#define ZD_LANES 1
#include "driven_four_bar.c"
#endif
#if (ZD_SETS) & ZD_SET_AVX2_4
#define ZD_UNIT 1
#define ZD_LANES 4
#include "driven_four_bar.c"
#endif
#if (ZD_SETS) & ZD_SET_AVX512_1
#define ZD_UNIT 2
#define ZD_LANES 1
#include "driven_four_bar.c"
#endif
#if (ZD_SETS) & ZD_SET_AVX512_8
#define ZD_UNIT 2
#define ZD_LANES 8
#include "driven_four_bar.c"
#endif

const zd_direct zd_driven_four_bar_direct[] = {
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
    const zd_stored *restrict const k = (const zd_stored *)((const double *)data + 18 * ZD_LANES);
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
    const zd_real added0 = added ? (zd_real)added[0] : ZD_SPLAT(0.0), added1 = added ? (zd_real)added[1] : ZD_SPLAT(0.0), added2 = added ? (zd_real)added[2] : ZD_SPLAT(0.0);
    const zd_real x147 = t * k[14];
    const zd_real x163 = v2 * v2;
    const zd_real x165 = v0 * v0;
    const zd_real x167 = v1 * v1;
    const zd_real angle16[ZD_PADDED(4)] = {p1, p0, p2, x147};
    zd_real sine16[ZD_PADDED(4)], cosine16[ZD_PADDED(4)];
    ZD_SINES(4, angle16, sine16, cosine16);
    const zd_real x131 = cosine16[2] * k[3];
    const zd_real x132 = cosine16[0] * k[2];
    const zd_real x133 = k[1] * cosine16[1];
    const zd_real x138 = sine16[2] * k[3];
    const zd_real x139 = k[1] * sine16[1];
    const zd_real x140 = sine16[0] * k[2];
    const zd_real x185 = ZD_FNMA(x131, x140, x132 * x138);
    const zd_real x186 = 1.0 / x185;
    const zd_real x187 = x131 * x186;
    const zd_real x188 = x138 * x186;
    const zd_real x189 = x132 * x186;
    const zd_real x191 = x140 * x186;
    const zd_real x198 = ZD_FNMA(sine16[3], k[27], added2);
    const zd_real x206 = ZD_FMA(x139, x198, ZD_FMA(x131, x163, ZD_FMA(x132, x167, x133 * x165)) + added0);
    const zd_real x208 = ZD_FNMA(x133, x198, ZD_FMA(x138, x163, ZD_FMA(x140, x167, x139 * x165)) + added1);
    const zd_real x211 = ZD_FMA(x188, x208, x187 * x206);
    const zd_real x216 = ZD_FMA(x191, x208, x189 * x206);
    vdot[0] = x198;
    vdot[1] = x211;
    vdot[2] = -x216;
    if (lambda || power) {
        const zd_real x25 = ZD_FNMA(sine16[0], cosine16[1], cosine16[0] * sine16[1]);
        const zd_real x36 = ZD_FMA(sine16[0], sine16[1], cosine16[0] * cosine16[1]) * k[16];
        const zd_real x44 = ZD_FNMA(cosine16[1], sine16[2], sine16[1] * cosine16[2]);
        const zd_real x53 = ZD_FMA(sine16[1], sine16[2], cosine16[1] * cosine16[2]) * k[18];
        const zd_real x63 = ZD_FNMA(cosine16[0], sine16[2], sine16[0] * cosine16[2]);
        const zd_real x71 = ZD_FMA(sine16[0], sine16[2], cosine16[0] * cosine16[2]) * k[21];
        const zd_real x79 = v1 * (x25 * k[16]);
        const zd_real x82 = v2 * (x44 * k[18]);
        const zd_real x86 = v0 - v1;
        const zd_real x89 = v0 - v2;
        const zd_real x92 = v1 - v2;
        const zd_real x201 = ZD_FMA(cosine16[0], k[24], ZD_FNMA(v0, x25 * (k[16] * (v1 + x86)), v2 * (x63 * (0.5 * (k[20] * (v1 - x92))))));
        const zd_real x203 = ZD_FNMA(cosine16[2], k[25], 0.5 * ZD_FMA(v1, x63 * (k[20] * (v2 + x92)), v0 * (x44 * (k[17] * (v2 + x89)))));
        const zd_real x224 = ZD_FMA(cosine16[1], k[23], ZD_FNMA(x82, x89, ZD_FNMA(x79, x86, (x79 + x82) * v0))) + ZD_FNMA(x53, x216, ZD_FMA(x36, x211, k[15] * x198));
        const zd_real x232 = x201 + ZD_FNMA(x71, x216, ZD_FMA(k[19], x211, x36 * x198));
        const zd_real x240 = x203 - ZD_FNMA(k[22], x216, ZD_FMA(x71, x211, x53 * x198));
        const zd_real x245 = ZD_FMA(x189, x240, x187 * x232);
        const zd_real x251 = ZD_FMA(x191, x240, x188 * x232);
        const zd_real x258 = x224 + ZD_FNMA(x133, x251, x139 * x245);
        const zd_real angle158[ZD_PADDED(1)] = {x147};
        zd_real sine158[ZD_PADDED(1)], cosine158[ZD_PADDED(1)];
        ZD_SINES(1, angle158, sine158, cosine158);
        if (lambda) lambda[0] = -x245;
        if (lambda) lambda[1] = -x251;
        if (lambda) lambda[2] = -x258;
        if (power) power[0] = ZD_FMA(cosine158[0], k[26], k[12]) * x258;
    }
    if (pivots) {
        pivots[0] = ZD_SPLAT(1.0);
        pivots[1] = x185;
    }
    return ZD_DONE;
}

ZD_ON_UNIT static int ZD_NAMED(correct_0)(const void *data, const double *at_time, const double *at_p,
    const double *at_v, double *to_Phi, double *to_dp, double *to_dv)
{
    const zd_stored *restrict const k = (const zd_stored *)((const double *)data + 18 * ZD_LANES);
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
    const zd_real x147 = t * k[14];
    const zd_real angle16[ZD_PADDED(4)] = {p1, p0, p2, x147};
    zd_real sine16[ZD_PADDED(4)], cosine16[ZD_PADDED(4)];
    ZD_SINES(4, angle16, sine16, cosine16);
    const zd_real x131 = cosine16[2] * k[3];
    const zd_real x132 = cosine16[0] * k[2];
    const zd_real x133 = k[1] * cosine16[1];
    const zd_real x137 = x131 + (x132 + (x133 - k[0]));
    const zd_real x138 = sine16[2] * k[3];
    const zd_real x139 = k[1] * sine16[1];
    const zd_real x140 = sine16[0] * k[2];
    const zd_real x142 = x138 + (x139 + x140);
    const zd_real x154 = ZD_FNMA(t, k[12], ZD_FNMA(sine16[3], k[13], p0 - k[11]));
    const zd_real x186 = 1.0 / ZD_FNMA(x131, x140, x132 * x138);
    const zd_real x187 = x131 * x186;
    const zd_real x188 = x138 * x186;
    const zd_real x189 = x132 * x186;
    const zd_real x191 = x140 * x186;
    const zd_real x277 = v0 - ZD_FMA(cosine16[3], k[26], k[12]);
    const zd_real x280 = ZD_FMA(x139, x154, x137);
    const zd_real x282 = ZD_FNMA(x133, x154, x142);
    const zd_real x294 = ZD_FMS(x139, x277, ZD_FMA(v2, x138, ZD_FMA(v1, x140, v0 * x139)));
    const zd_real x296 = ZD_FNMA(x133, x277, ZD_FMA(v2, x131, ZD_FMA(v1, x132, v0 * x133)));
    Phi[0] = x137;
    Phi[1] = x142;
    Phi[2] = x154;
    dp[0] = x154;
    dp[1] = ZD_FMA(x188, x282, x187 * x280);
    dp[2] = -ZD_FMA(x191, x282, x189 * x280);
    dv[0] = x277;
    dv[1] = ZD_FMA(x188, x296, x187 * x294);
    dv[2] = -ZD_FMA(x191, x296, x189 * x294);
    return ZD_DONE;
}

#if ZD_LANES == 1
ZD_ON_UNIT static int ZD_NAMED(land_0)(const void *data, const double *at_time, const double *at_p,
    double *to_v, const double *where_allowed, double *to_Phi, double *to_dp, double *to_pdot, double *to_vdot,
    double *to_lambda, double *to_power, double *to_pivots)
{
    const zd_stored *restrict const k = (const zd_stored *)((const double *)data + 18 * ZD_LANES);
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
    const zd_real x147 = t * k[14];
    const zd_real angle16[ZD_PADDED(4)] = {p1, p0, p2, x147};
    zd_real sine16[ZD_PADDED(4)], cosine16[ZD_PADDED(4)];
    ZD_SINES(4, angle16, sine16, cosine16);
    const zd_real x131 = cosine16[2] * k[3];
    const zd_real x132 = cosine16[0] * k[2];
    const zd_real x133 = k[1] * cosine16[1];
    const zd_real x137 = x131 + (x132 + (x133 - k[0]));
    const zd_real x138 = sine16[2] * k[3];
    const zd_real x139 = k[1] * sine16[1];
    const zd_real x140 = sine16[0] * k[2];
    const zd_real x142 = x138 + (x139 + x140);
    const zd_real x154 = ZD_FNMA(t, k[12], ZD_FNMA(sine16[3], k[13], p0 - k[11]));
    Phi[0] = x137;
    Phi[1] = x142;
    Phi[2] = x154;
    if (!(fabs(Phi[0]) <= allowed[0]) || !(fabs(Phi[1]) <= allowed[1]) || !(fabs(Phi[2]) <= allowed[2])) {
        const zd_real x185 = ZD_FNMA(x131, x140, x132 * x138);
        const zd_real x186 = 1.0 / x185;
        const zd_real x187 = x131 * x186;
        const zd_real x188 = x138 * x186;
        const zd_real x189 = x132 * x186;
        const zd_real x191 = x140 * x186;
        const zd_real x280 = ZD_FMA(x139, x154, x137);
        const zd_real x282 = ZD_FNMA(x133, x154, x142);
        dp[0] = x154;
        dp[1] = ZD_FMA(x188, x282, x187 * x280);
        dp[2] = -ZD_FMA(x191, x282, x189 * x280);
        return ZD_NO_CONVERGENCE;
    }
    const zd_real x185 = ZD_FNMA(x131, x140, x132 * x138);
    const zd_real x186 = 1.0 / x185;
    const zd_real x187 = x131 * x186;
    const zd_real x188 = x138 * x186;
    const zd_real x189 = x132 * x186;
    const zd_real x191 = x140 * x186;
    const zd_real angle158[ZD_PADDED(1)] = {x147};
    zd_real sine158[ZD_PADDED(1)], cosine158[ZD_PADDED(1)];
    ZD_SINES(1, angle158, sine158, cosine158);
    const zd_real x161 = ZD_FMA(cosine158[0], k[26], k[12]);
    const zd_real x324 = before0 - x161;
    const zd_real x327 = ZD_FMS(x139, x324, ZD_FMA(x138, before2, ZD_FMA(x140, before1, x139 * before0)));
    const zd_real x329 = ZD_FNMA(x133, x324, ZD_FMA(x131, before2, ZD_FMA(x132, before1, x133 * before0)));
    const zd_real v0 = before0 - x324;
    const zd_real v1 = before1 - ZD_FMA(x188, x329, x187 * x327);
    const zd_real v2 = before2 - (-ZD_FMA(x191, x329, x189 * x327));
    const zd_real x163 = v2 * v2;
    const zd_real x165 = v0 * v0;
    const zd_real x167 = v1 * v1;
    const zd_real x178 = sine16[3] * k[27];
    const zd_real x341 = ZD_FNMA(x139, x178, ZD_FMA(x131, x163, ZD_FMA(x132, x167, x133 * x165)));
    const zd_real x344 = ZD_FMA(x133, x178, ZD_FMA(x138, x163, ZD_FMA(x140, x167, x139 * x165)));
    const zd_real x347 = ZD_FMA(x188, x344, x187 * x341);
    const zd_real x352 = ZD_FMA(x191, x344, x189 * x341);
    v[0] = v0;
    v[1] = v1;
    v[2] = v2;
    vdot[0] = -x178;
    vdot[1] = x347;
    vdot[2] = -x352;
    if (lambda || power) {
        const zd_real x25 = ZD_FNMA(sine16[0], cosine16[1], cosine16[0] * sine16[1]);
        const zd_real x36 = ZD_FMA(sine16[0], sine16[1], cosine16[0] * cosine16[1]) * k[16];
        const zd_real x44 = ZD_FNMA(cosine16[1], sine16[2], sine16[1] * cosine16[2]);
        const zd_real x53 = ZD_FMA(sine16[1], sine16[2], cosine16[1] * cosine16[2]) * k[18];
        const zd_real x63 = ZD_FNMA(cosine16[0], sine16[2], sine16[0] * cosine16[2]);
        const zd_real x71 = ZD_FMA(sine16[0], sine16[2], cosine16[0] * cosine16[2]) * k[21];
        const zd_real x79 = v1 * (x25 * k[16]);
        const zd_real x82 = v2 * (x44 * k[18]);
        const zd_real x86 = v0 - v1;
        const zd_real x89 = v0 - v2;
        const zd_real x92 = v1 - v2;
        const zd_real x201 = ZD_FMA(cosine16[0], k[24], ZD_FNMA(v0, x25 * (k[16] * (v1 + x86)), v2 * (x63 * (0.5 * (k[20] * (v1 - x92))))));
        const zd_real x203 = ZD_FNMA(cosine16[2], k[25], 0.5 * ZD_FMA(v1, x63 * (k[20] * (v2 + x92)), v0 * (x44 * (k[17] * (v2 + x89)))));
        const zd_real x361 = ZD_FMA(cosine16[1], k[23], ZD_FNMA(x82, x89, ZD_FNMA(x79, x86, (x79 + x82) * v0))) + ZD_FNMA(x53, x352, ZD_FNMA(k[15], x178, x36 * x347));
        const zd_real x370 = x201 + ZD_FNMA(x71, x352, ZD_FNMA(x36, x178, k[19] * x347));
        const zd_real x379 = x203 - ZD_FNMA(k[22], x352, ZD_FNMA(x53, x178, x71 * x347));
        const zd_real x384 = ZD_FMA(x189, x379, x187 * x370);
        const zd_real x390 = ZD_FMA(x191, x379, x188 * x370);
        const zd_real x397 = x361 + ZD_FNMA(x133, x390, x139 * x384);
        if (lambda) lambda[0] = -x384;
        if (lambda) lambda[1] = -x390;
        if (lambda) lambda[2] = -x397;
        if (power) power[0] = x161 * x397;
    }
    if (pivots) {
        pivots[0] = ZD_SPLAT(1.0);
        pivots[1] = x185;
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
