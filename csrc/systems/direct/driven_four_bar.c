/* Written by tests/direct_sources.py with SymPy 1.14.0, from tests/symbolic_counterparts.py. */
#ifndef ZD_LANES
#include "driven_four_bar.h"

#include <math.h>
#include "../../include/zerodrift/units.h"

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

static const int solve_0[] = {0, 1, 2};
static const int row_0[] = {2, 1, 0};
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
    const zd_real x59 = v0 * v0;
    const zd_real x63 = v1 * v1;
    const zd_real x74 = v2 * v2;
    const zd_real x145 = t * k[14];
    const zd_real angle14[ZD_PADDED(4)] = {p0, p1, p2, x145};
    zd_real sine14[ZD_PADDED(4)], cosine14[ZD_PADDED(4)];
    ZD_SINES(4, angle14, sine14, cosine14);
    const zd_real x60 = k[1] * sine14[0];
    const zd_real x61 = x59 * x60;
    const zd_real x71 = sine14[1] * k[2];
    const zd_real x78 = ZD_FMA(x63, x71, x61);
    const zd_real x84 = k[1] * cosine14[0];
    const zd_real x85 = x59 * x84;
    const zd_real x91 = cosine14[1] * k[2];
    const zd_real x95 = ZD_FMA(x63, x91, x85);
    const zd_real x135 = cosine14[2] * k[3];
    const zd_real x139 = sine14[2] * k[3];
    const zd_real x184 = 1.0 / x91;
    const zd_real x185 = x71 * x184;
    const zd_real x191 = ZD_FMS(x135, x185, x139);
    const zd_real x192 = 1.0 / x191;
    const zd_real x198 = ZD_FNMA(sine14[3], k[32], added2);
    const zd_real x209 = ZD_FNMA(x84, x198, ZD_FMA(x74, x139, x78) + added1);
    const zd_real x213 = x192 * ZD_FMA(x185, x209, ZD_FMA(x60, x198, ZD_FMA(x74, x135, x95) + added0));
    const zd_real x216 = x184 * ZD_FNMA(x135, x213, x209);
    vdot[0] = x198;
    vdot[1] = x216;
    vdot[2] = x213;
    if (lambda || power) {
        const zd_real x28 = ZD_FMA(sine14[0], sine14[1], cosine14[0] * cosine14[1]) * k[16];
        const zd_real x39 = 0.5 * (ZD_FMA(sine14[0], sine14[2], cosine14[0] * cosine14[2]) * k[18]);
        const zd_real x52 = 0.5 * (ZD_FMA(sine14[1], sine14[2], cosine14[1] * cosine14[2]) * k[21]);
        const zd_real x68 = -ZD_FMA(x63, sine14[1] * k[23], x61);
        const zd_real x80 = -ZD_FMA(x74, sine14[2] * k[25], x78);
        const zd_real x89 = -ZD_FMA(x63, cosine14[1] * k[23], x85);
        const zd_real x97 = -ZD_FMA(x74, cosine14[2] * k[25], x95);
        const zd_real x199 = ZD_FMA(cosine14[0], k[28], ZD_FNMA(sine14[0], ZD_FMA(k[17], x97, k[24] * x89), cosine14[0] * ZD_FMA(k[17], x80, x68 * k[24])));
        const zd_real x201 = ZD_FMA(cosine14[1], k[29], ZD_FNMA(sine14[1], ZD_FMA(k[20], x97, x89 * k[26]), cosine14[1] * ZD_FMA(k[20], x80, x68 * k[26])));
        const zd_real x236 = ZD_FMA(cosine14[2], k[30], 0.5 * (ZD_FNMA(sine14[2], x97, cosine14[2] * x80) * k[27])) + ZD_FMA(k[22], x213, ZD_FMA(x52, x216, x39 * x198));
        const zd_real x238 = x184 * (x201 + ZD_FMA(x52, x213, ZD_FMA(k[19], x216, x28 * x198)));
        const zd_real x243 = x192 * ZD_FMS(x135, x238, x236);
        const zd_real x246 = ZD_FMS(x185, x243, x238);
        const zd_real x251 = (x199 + ZD_FMA(x39, x213, ZD_FMA(x28, x216, k[15] * x198))) + ZD_FNMA(x60, x243, x84 * x246);
        const zd_real angle158[ZD_PADDED(1)] = {x145};
        zd_real sine158[ZD_PADDED(1)], cosine158[ZD_PADDED(1)];
        ZD_SINES(1, angle158, sine158, cosine158);
        if (lambda) lambda[0] = x243;
        if (lambda) lambda[1] = x246;
        if (lambda) lambda[2] = -x251;
        if (power) power[0] = ZD_FMA(cosine158[0], k[31], k[12]) * x251;
    }
    if (pivots) {
        pivots[0] = ZD_SPLAT(1.0);
        pivots[1] = x91;
        pivots[2] = x191;
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
    const zd_real x145 = t * k[14];
    const zd_real angle14[ZD_PADDED(4)] = {p0, p1, p2, x145};
    zd_real sine14[ZD_PADDED(4)], cosine14[ZD_PADDED(4)];
    ZD_SINES(4, angle14, sine14, cosine14);
    const zd_real x60 = k[1] * sine14[0];
    const zd_real x71 = sine14[1] * k[2];
    const zd_real x84 = k[1] * cosine14[0];
    const zd_real x91 = cosine14[1] * k[2];
    const zd_real x135 = cosine14[2] * k[3];
    const zd_real x138 = x135 + (x91 + (x84 - k[0]));
    const zd_real x139 = sine14[2] * k[3];
    const zd_real x141 = x139 + (x60 + x71);
    const zd_real x153 = ZD_FNMA(t, k[12], ZD_FNMA(sine14[3], k[13], p0 - k[11]));
    const zd_real x184 = 1.0 / x91;
    const zd_real x185 = x71 * x184;
    const zd_real x192 = 1.0 / ZD_FMS(x135, x185, x139);
    const zd_real x270 = v0 - ZD_FMA(cosine14[3], k[31], k[12]);
    const zd_real x275 = ZD_FNMA(x84, x153, x141);
    const zd_real x279 = x192 * ZD_FMA(x185, x275, ZD_FMA(x60, x153, x138));
    const zd_real x287 = ZD_FNMA(x84, x270, ZD_FMA(v2, x135, ZD_FMA(v1, x91, v0 * x84)));
    const zd_real x291 = x192 * ZD_FMA(x185, x287, ZD_FMS(x60, x270, ZD_FMA(v2, x139, ZD_FMA(v1, x71, v0 * x60))));
    Phi[0] = x138;
    Phi[1] = x141;
    Phi[2] = x153;
    dp[0] = x153;
    dp[1] = x184 * ZD_FNMA(x135, x279, x275);
    dp[2] = x279;
    dv[0] = x270;
    dv[1] = x184 * ZD_FNMA(x135, x291, x287);
    dv[2] = x291;
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
    const zd_real x145 = t * k[14];
    const zd_real angle14[ZD_PADDED(4)] = {p0, p1, p2, x145};
    zd_real sine14[ZD_PADDED(4)], cosine14[ZD_PADDED(4)];
    ZD_SINES(4, angle14, sine14, cosine14);
    const zd_real x60 = k[1] * sine14[0];
    const zd_real x71 = sine14[1] * k[2];
    const zd_real x84 = k[1] * cosine14[0];
    const zd_real x91 = cosine14[1] * k[2];
    const zd_real x135 = cosine14[2] * k[3];
    const zd_real x138 = x135 + (x91 + (x84 - k[0]));
    const zd_real x139 = sine14[2] * k[3];
    const zd_real x141 = x139 + (x60 + x71);
    const zd_real x153 = ZD_FNMA(t, k[12], ZD_FNMA(sine14[3], k[13], p0 - k[11]));
    Phi[0] = x138;
    Phi[1] = x141;
    Phi[2] = x153;
    if (!(fabs(Phi[0]) <= allowed[0]) || !(fabs(Phi[1]) <= allowed[1]) || !(fabs(Phi[2]) <= allowed[2])) {
        const zd_real x184 = 1.0 / x91;
        const zd_real x185 = x71 * x184;
        const zd_real x191 = ZD_FMS(x135, x185, x139);
        const zd_real x192 = 1.0 / x191;
        const zd_real x275 = ZD_FNMA(x84, x153, x141);
        const zd_real x279 = x192 * ZD_FMA(x185, x275, ZD_FMA(x60, x153, x138));
        dp[0] = x153;
        dp[1] = x184 * ZD_FNMA(x135, x279, x275);
        dp[2] = x279;
        return ZD_NO_CONVERGENCE;
    }
    const zd_real x184 = 1.0 / x91;
    const zd_real x185 = x71 * x184;
    const zd_real x191 = ZD_FMS(x135, x185, x139);
    const zd_real x192 = 1.0 / x191;
    const zd_real angle158[ZD_PADDED(1)] = {x145};
    zd_real sine158[ZD_PADDED(1)], cosine158[ZD_PADDED(1)];
    ZD_SINES(1, angle158, sine158, cosine158);
    const zd_real x161 = ZD_FMA(cosine158[0], k[31], k[12]);
    const zd_real x313 = before0 - x161;
    const zd_real x318 = ZD_FNMA(x84, x313, ZD_FMA(x135, before2, ZD_FMA(x91, before1, x84 * before0)));
    const zd_real x322 = x192 * ZD_FMA(x185, x318, ZD_FMS(x60, x313, ZD_FMA(x139, before2, ZD_FMA(x71, before1, x60 * before0))));
    const zd_real v0 = before0 - x313;
    const zd_real v1 = before1 - (x184 * ZD_FNMA(x135, x322, x318));
    const zd_real v2 = before2 - x322;
    const zd_real x59 = v0 * v0;
    const zd_real x61 = x59 * x60;
    const zd_real x63 = v1 * v1;
    const zd_real x74 = v2 * v2;
    const zd_real x78 = ZD_FMA(x63, x71, x61);
    const zd_real x85 = x59 * x84;
    const zd_real x95 = ZD_FMA(x63, x91, x85);
    const zd_real x169 = sine14[3] * k[32];
    const zd_real x331 = ZD_FMA(x84, x169, ZD_FMA(x74, x139, x78));
    const zd_real x335 = x192 * ZD_FMA(x185, x331, ZD_FNMA(x60, x169, ZD_FMA(x74, x135, x95)));
    const zd_real x338 = x184 * ZD_FNMA(x135, x335, x331);
    v[0] = v0;
    v[1] = v1;
    v[2] = v2;
    vdot[0] = -x169;
    vdot[1] = x338;
    vdot[2] = x335;
    if (lambda || power) {
        const zd_real x28 = ZD_FMA(sine14[0], sine14[1], cosine14[0] * cosine14[1]) * k[16];
        const zd_real x39 = 0.5 * (ZD_FMA(sine14[0], sine14[2], cosine14[0] * cosine14[2]) * k[18]);
        const zd_real x52 = 0.5 * (ZD_FMA(sine14[1], sine14[2], cosine14[1] * cosine14[2]) * k[21]);
        const zd_real x68 = -ZD_FMA(x63, sine14[1] * k[23], x61);
        const zd_real x80 = -ZD_FMA(x74, sine14[2] * k[25], x78);
        const zd_real x89 = -ZD_FMA(x63, cosine14[1] * k[23], x85);
        const zd_real x97 = -ZD_FMA(x74, cosine14[2] * k[25], x95);
        const zd_real x199 = ZD_FMA(cosine14[0], k[28], ZD_FNMA(sine14[0], ZD_FMA(k[17], x97, k[24] * x89), cosine14[0] * ZD_FMA(k[17], x80, x68 * k[24])));
        const zd_real x201 = ZD_FMA(cosine14[1], k[29], ZD_FNMA(sine14[1], ZD_FMA(k[20], x97, x89 * k[26]), cosine14[1] * ZD_FMA(k[20], x80, x68 * k[26])));
        const zd_real x361 = ZD_FMA(cosine14[2], k[30], 0.5 * (ZD_FNMA(sine14[2], x97, cosine14[2] * x80) * k[27])) + ZD_FMA(k[22], x335, ZD_FNMA(x39, x169, x52 * x338));
        const zd_real x363 = x184 * (x201 + ZD_FMA(x52, x335, ZD_FNMA(x28, x169, k[19] * x338)));
        const zd_real x368 = x192 * ZD_FMS(x135, x363, x361);
        const zd_real x371 = ZD_FMS(x185, x368, x363);
        const zd_real x376 = (x199 + ZD_FMA(x39, x335, ZD_FNMA(k[15], x169, x28 * x338))) + ZD_FNMA(x60, x368, x84 * x371);
        if (lambda) lambda[0] = x368;
        if (lambda) lambda[1] = x371;
        if (lambda) lambda[2] = -x376;
        if (power) power[0] = x161 * x376;
    }
    if (pivots) {
        pivots[0] = ZD_SPLAT(1.0);
        pivots[1] = x91;
        pivots[2] = x191;
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
    {3, solve_0, row_0, column_0, ZD_NAMED(accelerate_0), ZD_NAMED(correct_0), ZD_LANDING(land_0)},
};
#undef ZD_LANDING

#undef ZD_UNIT
#undef ZD_LANES
#endif
