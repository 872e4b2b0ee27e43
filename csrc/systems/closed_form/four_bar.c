/* Written by python/write_closed_form.py with SymPy 1.14.0, from tests/support/symbolic_counterparts.py. */
#ifndef ZD_LANES
#include "four_bar.h"

#include <math.h>
#include "../../include/zerodrift/units.h"

/* Constants computed from the parameters alone, stored after them. */
void zd_four_bar_closed_form_constants(double *k)
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
static const int solve_1[] = {0, 1};
static const int row_1[] = {1, 0};
static const int column_1[] = {1, 2};

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

const zd_closed_form zd_four_bar_closed_form[] = {
#if (ZD_SETS) & ZD_SET_BASELINE_1
    {0, 1, 1, orders_0_1, 1, embeddings_0_1},
#endif
#if (ZD_SETS) & ZD_SET_BASELINE_2
    {0, 2, 1, orders_0_2, 0, NULL},
#endif
#if (ZD_SETS) & ZD_SET_AVX2_1
    {1, 1, 1, orders_1_1, 1, embeddings_1_1},
#endif
#if (ZD_SETS) & ZD_SET_AVX2_4
    {1, 4, 1, orders_1_4, 0, NULL},
#endif
#if (ZD_SETS) & ZD_SET_AVX512_1
    {2, 1, 1, orders_2_1, 1, embeddings_2_1},
#endif
#if (ZD_SETS) & ZD_SET_AVX512_8
    {2, 8, 1, orders_2_8, 0, NULL},
#endif
};

#else
#include "../../include/zerodrift/lanes.h"

ZD_ON_UNIT static int ZD_NAMED(accelerate_0)(const zd_elimination *self, const void *data, const double *at_inputs, const double *at_time, const double *at_p,
    const double *at_v, const double *with_added, double *to_pdot, double *to_vdot, double *to_lambda,
    double *to_power, double *to_pivots)
{
    const zd_stored *restrict const k = (const zd_stored *)((const double *)data + 14 * ZD_LANES);
    const zd_stored *restrict const input = (const zd_stored *)at_inputs;
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
    (void)self, (void)t, (void)k, (void)input, (void)time, (void)p, (void)v, (void)added, (void)pdot, (void)vdot, (void)lambda, (void)power, (void)pivots;
    const zd_real p0 = p[0], p1 = p[1], p2 = p[2];
    const zd_real v0 = v[0], v1 = v[1], v2 = v[2];
    const zd_real added0 = added ? (zd_real)added[0] : ZD_SPLAT(0.0), added1 = added ? (zd_real)added[1] : ZD_SPLAT(0.0);
    /* vdot (17) */
    const zd_real x78 = v1 * v1;
    const zd_real x82 = v2 * v2;
    const zd_real x89 = v0 * v0;
    const zd_real angle16[ZD_PADDED(3)] = {p1, p0, p2};
    zd_real sine16[ZD_PADDED(3)], cosine16[ZD_PADDED(3)];
    ZD_SINES(3, angle16, sine16, cosine16);
    const zd_real x36 = ZD_FMA(sine16[0], sine16[1], cosine16[0] * cosine16[1]) * k[12];
    const zd_real x44 = ZD_FNMA(cosine16[1], sine16[2], sine16[1] * cosine16[2]);
    const zd_real x53 = ZD_FMA(sine16[1], sine16[2], cosine16[1] * cosine16[2]) * k[14];
    const zd_real x63 = ZD_FNMA(cosine16[0], sine16[2], sine16[0] * cosine16[2]);
    const zd_real x71 = ZD_FMA(sine16[0], sine16[2], cosine16[0] * cosine16[2]) * k[17];
    const zd_real x79 = ZD_FNMA(sine16[0], cosine16[1], cosine16[0] * sine16[1]) * k[12];
    const zd_real x116 = cosine16[2] * k[3];
    const zd_real x117 = cosine16[0] * k[2];
    const zd_real x118 = k[1] * cosine16[1];
    const zd_real x123 = sine16[2] * k[3];
    const zd_real x124 = k[1] * sine16[1];
    const zd_real x125 = sine16[0] * k[2];
    const zd_real x146 = ZD_FNMA(x116, x125, x117 * x123);
    const zd_real x184 = ZD_FNMA(x118, x123, x116 * x124);
    const zd_real x189 = ZD_FNMA(x117, x124, x118 * x125);
    const zd_real x199 = ZD_FMA(x71, x189, ZD_FMA(k[15], x184, x36 * x146));
    const zd_real x204 = ZD_FMA(k[18], x189, ZD_FMA(x71, x184, x53 * x146));
    const zd_real x209 = ZD_FMA(x189, x204, ZD_FMA(x184, x199, x146 * ZD_FMA(x53, x189, ZD_FMA(x36, x184, k[11] * x146))));
    const zd_real x211 = 1.0 / (x146 * x209);
    const zd_real x212 = x209 * x211;
    const zd_real x216 = ZD_FMA(x82, x116, ZD_FMA(x78, x117, x89 * x118)) + added0;
    const zd_real x217 = ZD_FMA(x82, x123, ZD_FMA(x78, x125, x89 * x124)) + added1;
    const zd_real x220 = ZD_FMA(cosine16[0], k[20], ZD_FNMA(x79, x89, x82 * (x63 * k[17])));
    const zd_real x222 = ZD_FNMA(cosine16[2], k[21], 0.5 * ZD_FMA(x78, x63 * k[16], x89 * (x44 * k[13])));
    const zd_real x225 = ZD_FMA(x123, x217, x116 * x216);
    const zd_real x230 = ZD_FMA(x125, x217, x117 * x216);
    const zd_real x244 = ZD_FMS(x189, x222, ZD_FMA(x184, x220, x146 * ZD_FMA(cosine16[1], k[19], ZD_FMA(x82, x44 * k[14], x78 * x79))));
    const zd_real x248 = x211 * (x146 * ZD_FMS(x146, x244, ZD_FNMA(x204, x230, x199 * x225)));
    const zd_real x254 = ZD_FMA(x248, x184 * x212, x212 * x225);
    const zd_real x259 = ZD_FNMA(x212, x230, x248 * (x189 * x212));
    vdot[0] = x248;
    vdot[1] = x254;
    vdot[2] = x259;
    /* lambda (8); power (28) */
    if (lambda || power) {
        const zd_real x272 = x220 + ZD_FMA(x71, x259, ZD_FMA(k[15], x254, x36 * x248));
        const zd_real x279 = x222 - ZD_FMA(k[18], x259, ZD_FMA(x71, x254, x53 * x248));
        if (lambda) lambda[0] = -(x212 * ZD_FMA(x117, x279, x116 * x272));
        if (lambda) lambda[1] = -(x212 * ZD_FMA(x125, x279, x123 * x272));
        if (power) power[0] = ZD_SPLAT(0.0);
    }
    if (pivots) {
        pivots[0] = x146;
        pivots[1] = ZD_SPLAT(1.0);
    }
    return ZD_DONE;
}

ZD_ON_UNIT static int ZD_NAMED(correct_0)(const zd_elimination *self, const void *data, const double *at_inputs, const double *at_time, const double *at_p,
    const double *at_v, double *to_Phi, double *to_dp, double *to_dv)
{
    const zd_stored *restrict const k = (const zd_stored *)((const double *)data + 14 * ZD_LANES);
    const zd_stored *restrict const input = (const zd_stored *)at_inputs;
    const zd_stored *restrict const time = (const zd_stored *)at_time;
    const zd_stored *restrict const p = (const zd_stored *)at_p;
    const zd_stored *restrict const v = (const zd_stored *)at_v;
    zd_stored *restrict const Phi = (zd_stored *)to_Phi;
    zd_stored *restrict const dp = (zd_stored *)to_dp;
    zd_stored *restrict const dv = (zd_stored *)to_dv;
    const zd_real t = *time;
    (void)self, (void)t, (void)k, (void)input, (void)time, (void)p, (void)v, (void)Phi, (void)dp, (void)dv;
    const zd_real p0 = p[0], p1 = p[1], p2 = p[2];
    const zd_real v0 = v[0], v1 = v[1], v2 = v[2];
    /* Phi (3); dp (25a), (26a), (27a); dv (25b), (26b), (27b) */
    const zd_real angle16[ZD_PADDED(3)] = {p1, p0, p2};
    zd_real sine16[ZD_PADDED(3)], cosine16[ZD_PADDED(3)];
    ZD_SINES(3, angle16, sine16, cosine16);
    const zd_real x36 = ZD_FMA(sine16[0], sine16[1], cosine16[0] * cosine16[1]) * k[12];
    const zd_real x53 = ZD_FMA(sine16[1], sine16[2], cosine16[1] * cosine16[2]) * k[14];
    const zd_real x71 = ZD_FMA(sine16[0], sine16[2], cosine16[0] * cosine16[2]) * k[17];
    const zd_real x116 = cosine16[2] * k[3];
    const zd_real x117 = cosine16[0] * k[2];
    const zd_real x118 = k[1] * cosine16[1];
    const zd_real x122 = x116 + (x117 + (x118 - k[0]));
    const zd_real x123 = sine16[2] * k[3];
    const zd_real x124 = k[1] * sine16[1];
    const zd_real x125 = sine16[0] * k[2];
    const zd_real x127 = x123 + (x124 + x125);
    const zd_real x146 = ZD_FNMA(x116, x125, x117 * x123);
    const zd_real x184 = ZD_FNMA(x118, x123, x116 * x124);
    const zd_real x189 = ZD_FNMA(x117, x124, x118 * x125);
    const zd_real x199 = ZD_FMA(x71, x189, ZD_FMA(k[15], x184, x36 * x146));
    const zd_real x204 = ZD_FMA(k[18], x189, ZD_FMA(x71, x184, x53 * x146));
    const zd_real x209 = ZD_FMA(x189, x204, ZD_FMA(x184, x199, x146 * ZD_FMA(x53, x189, ZD_FMA(x36, x184, k[11] * x146))));
    const zd_real x211 = 1.0 / (x146 * x209);
    const zd_real x212 = x209 * x211;
    const zd_real x252 = x184 * x212;
    const zd_real x257 = x189 * x212;
    const zd_real x304 = ZD_FMA(v2, x123, ZD_FMA(v1, x125, v0 * x124));
    const zd_real x310 = ZD_FMA(v2, x116, ZD_FMA(v1, x117, v0 * x118));
    const zd_real x313 = ZD_FMA(x123, x127, x116 * x122);
    const zd_real x318 = ZD_FMA(x125, x127, x117 * x122);
    const zd_real x327 = x211 * (x146 * ZD_FNMA(x204, x318, x199 * x313));
    const zd_real x344 = ZD_FNMA(x116, x304, x123 * x310);
    const zd_real x349 = ZD_FNMA(x125, x310, x117 * x304);
    const zd_real x356 = x211 * (x146 * ZD_FMA(x204, x349, x199 * x344));
    Phi[0] = x122;
    Phi[1] = x127;
    dp[0] = -x327;
    dp[1] = ZD_FNMA(x252, x327, x212 * x313);
    dp[2] = -ZD_FMA(x257, x327, x212 * x318);
    dv[0] = -x356;
    dv[1] = ZD_FNMA(x252, x356, x212 * x344);
    dv[2] = ZD_FNMA(x257, x356, x212 * x349);
    return ZD_DONE;
}

#if ZD_LANES == 1
ZD_ON_UNIT static int ZD_NAMED(finish_0)(const zd_elimination *self, const void *data, const double *at_inputs, const double *at_time, const double *at_p,
    double *to_v, const double *where_allowed, double *to_Phi, double *to_dp, double *to_pdot, double *to_vdot,
    double *to_lambda, double *to_power, double *to_pivots)
{
    const zd_stored *restrict const k = (const zd_stored *)((const double *)data + 14 * ZD_LANES);
    const zd_stored *restrict const input = (const zd_stored *)at_inputs;
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
    (void)self, (void)t, (void)k, (void)input, (void)time, (void)p, (void)allowed, (void)v, (void)Phi, (void)dp, (void)pdot, (void)vdot, (void)lambda, (void)power, (void)pivots;
    const zd_real p0 = p[0], p1 = p[1], p2 = p[2];
    const zd_real before0 = v[0], before1 = v[1], before2 = v[2];
    /* Phi (3) */
    const zd_real angle16[ZD_PADDED(3)] = {p1, p0, p2};
    zd_real sine16[ZD_PADDED(3)], cosine16[ZD_PADDED(3)];
    ZD_SINES(3, angle16, sine16, cosine16);
    const zd_real x116 = cosine16[2] * k[3];
    const zd_real x117 = cosine16[0] * k[2];
    const zd_real x118 = k[1] * cosine16[1];
    const zd_real x122 = x116 + (x117 + (x118 - k[0]));
    const zd_real x123 = sine16[2] * k[3];
    const zd_real x124 = k[1] * sine16[1];
    const zd_real x125 = sine16[0] * k[2];
    const zd_real x127 = x123 + (x124 + x125);
    Phi[0] = x122;
    Phi[1] = x127;
    if (!(fabs(Phi[0]) <= allowed[0]) || !(fabs(Phi[1]) <= allowed[1])) {
        /* dp (25a), (26a), (27a) */
        const zd_real x36 = ZD_FMA(sine16[0], sine16[1], cosine16[0] * cosine16[1]) * k[12];
        const zd_real x53 = ZD_FMA(sine16[1], sine16[2], cosine16[1] * cosine16[2]) * k[14];
        const zd_real x71 = ZD_FMA(sine16[0], sine16[2], cosine16[0] * cosine16[2]) * k[17];
        const zd_real x146 = ZD_FNMA(x116, x125, x117 * x123);
        const zd_real x184 = ZD_FNMA(x118, x123, x116 * x124);
        const zd_real x189 = ZD_FNMA(x117, x124, x118 * x125);
        const zd_real x199 = ZD_FMA(x71, x189, ZD_FMA(k[15], x184, x36 * x146));
        const zd_real x204 = ZD_FMA(k[18], x189, ZD_FMA(x71, x184, x53 * x146));
        const zd_real x209 = ZD_FMA(x189, x204, ZD_FMA(x184, x199, x146 * ZD_FMA(x53, x189, ZD_FMA(x36, x184, k[11] * x146))));
        const zd_real x211 = 1.0 / (x146 * x209);
        const zd_real x212 = x209 * x211;
        const zd_real x252 = x184 * x212;
        const zd_real x257 = x189 * x212;
        const zd_real x313 = ZD_FMA(x123, x127, x116 * x122);
        const zd_real x318 = ZD_FMA(x125, x127, x117 * x122);
        const zd_real x327 = x211 * (x146 * ZD_FNMA(x204, x318, x199 * x313));
        dp[0] = -x327;
        dp[1] = ZD_FNMA(x252, x327, x212 * x313);
        dp[2] = -ZD_FMA(x257, x327, x212 * x318);
        return ZD_NO_CONVERGENCE;
    }
    /* dv (25b), (26b), (27b) */
    const zd_real x36 = ZD_FMA(sine16[0], sine16[1], cosine16[0] * cosine16[1]) * k[12];
    const zd_real x53 = ZD_FMA(sine16[1], sine16[2], cosine16[1] * cosine16[2]) * k[14];
    const zd_real x71 = ZD_FMA(sine16[0], sine16[2], cosine16[0] * cosine16[2]) * k[17];
    const zd_real x146 = ZD_FNMA(x116, x125, x117 * x123);
    const zd_real x184 = ZD_FNMA(x118, x123, x116 * x124);
    const zd_real x189 = ZD_FNMA(x117, x124, x118 * x125);
    const zd_real x199 = ZD_FMA(x71, x189, ZD_FMA(k[15], x184, x36 * x146));
    const zd_real x204 = ZD_FMA(k[18], x189, ZD_FMA(x71, x184, x53 * x146));
    const zd_real x209 = ZD_FMA(x189, x204, ZD_FMA(x184, x199, x146 * ZD_FMA(x53, x189, ZD_FMA(x36, x184, k[11] * x146))));
    const zd_real x211 = 1.0 / (x146 * x209);
    const zd_real x212 = x209 * x211;
    const zd_real x252 = x184 * x212;
    const zd_real x257 = x189 * x212;
    const zd_real x379 = ZD_FMA(x123, before2, ZD_FMA(x125, before1, x124 * before0));
    const zd_real x385 = ZD_FMA(x116, before2, ZD_FMA(x117, before1, x118 * before0));
    const zd_real x389 = ZD_FNMA(x116, x379, x123 * x385);
    const zd_real x394 = ZD_FNMA(x125, x385, x117 * x379);
    const zd_real x401 = x211 * (x146 * ZD_FMA(x204, x394, x199 * x389));
    const zd_real v0 = before0 - (-x401);
    const zd_real v1 = before1 - ZD_FNMA(x252, x401, x212 * x389);
    const zd_real v2 = before2 - ZD_FNMA(x257, x401, x212 * x394);
    /* vdot (17) */
    const zd_real x44 = ZD_FNMA(cosine16[1], sine16[2], sine16[1] * cosine16[2]);
    const zd_real x63 = ZD_FNMA(cosine16[0], sine16[2], sine16[0] * cosine16[2]);
    const zd_real x78 = v1 * v1;
    const zd_real x79 = ZD_FNMA(sine16[0], cosine16[1], cosine16[0] * sine16[1]) * k[12];
    const zd_real x82 = v2 * v2;
    const zd_real x89 = v0 * v0;
    const zd_real x135 = ZD_FMA(x82, x116, ZD_FMA(x78, x117, x89 * x118));
    const zd_real x140 = ZD_FMA(x82, x123, ZD_FMA(x78, x125, x89 * x124));
    const zd_real x220 = ZD_FMA(cosine16[0], k[20], ZD_FNMA(x79, x89, x82 * (x63 * k[17])));
    const zd_real x222 = ZD_FNMA(cosine16[2], k[21], 0.5 * ZD_FMA(x78, x63 * k[16], x89 * (x44 * k[13])));
    const zd_real x244 = ZD_FMS(x189, x222, ZD_FMA(x184, x220, x146 * ZD_FMA(cosine16[1], k[19], ZD_FMA(x82, x44 * k[14], x78 * x79))));
    const zd_real x415 = ZD_FMA(x123, x140, x116 * x135);
    const zd_real x420 = ZD_FMA(x125, x140, x117 * x135);
    const zd_real x429 = x211 * (x146 * ZD_FMS(x146, x244, ZD_FNMA(x204, x420, x199 * x415)));
    const zd_real x433 = ZD_FMA(x252, x429, x212 * x415);
    const zd_real x437 = ZD_FNMA(x212, x420, x257 * x429);
    v[0] = v0;
    v[1] = v1;
    v[2] = v2;
    vdot[0] = x429;
    vdot[1] = x433;
    vdot[2] = x437;
    /* lambda (8); power (28) */
    if (lambda || power) {
        const zd_real x450 = x220 + ZD_FMA(x71, x437, ZD_FMA(k[15], x433, x36 * x429));
        const zd_real x457 = x222 - ZD_FMA(k[18], x437, ZD_FMA(x71, x433, x53 * x429));
        if (lambda) lambda[0] = -(x212 * ZD_FMA(x117, x457, x116 * x450));
        if (lambda) lambda[1] = -(x212 * ZD_FMA(x125, x457, x123 * x450));
        if (power) power[0] = ZD_SPLAT(0.0);
    }
    if (pivots) {
        pivots[0] = x146;
        pivots[1] = ZD_SPLAT(1.0);
    }
    return ZD_DONE;
}
#endif

#if ZD_LANES == 1
ZD_ON_UNIT static int ZD_NAMED(correct_1)(const zd_elimination *self, const void *data, const double *at_inputs, const double *at_time, const double *at_p,
    const double *at_v, double *to_Phi, double *to_dp, double *to_dv)
{
    const zd_stored *restrict const k = (const zd_stored *)((const double *)data + 14 * ZD_LANES);
    const zd_stored *restrict const input = (const zd_stored *)at_inputs;
    const zd_stored *restrict const time = (const zd_stored *)at_time;
    const zd_stored *restrict const p = (const zd_stored *)at_p;
    const zd_stored *restrict const v = (const zd_stored *)at_v;
    zd_stored *restrict const Phi = (zd_stored *)to_Phi;
    zd_stored *restrict const dp = (zd_stored *)to_dp;
    zd_stored *restrict const dv = (zd_stored *)to_dv;
    const zd_real t = *time;
    (void)self, (void)t, (void)k, (void)input, (void)time, (void)p, (void)v, (void)Phi, (void)dp, (void)dv;
    const zd_real p0 = p[0], p1 = p[1], p2 = p[2];
    const zd_real v0 = v[0], v1 = v[1], v2 = v[2];
    /* Phi (3); dp (25a), (26a), (27a); dv (25b), (26b), (27b) */
    const zd_real angle16[ZD_PADDED(3)] = {p1, p0, p2};
    zd_real sine16[ZD_PADDED(3)], cosine16[ZD_PADDED(3)];
    ZD_SINES(3, angle16, sine16, cosine16);
    const zd_real x36 = ZD_FMA(sine16[0], sine16[1], cosine16[0] * cosine16[1]) * k[12];
    const zd_real x53 = ZD_FMA(sine16[1], sine16[2], cosine16[1] * cosine16[2]) * k[14];
    const zd_real x71 = ZD_FMA(sine16[0], sine16[2], cosine16[0] * cosine16[2]) * k[17];
    const zd_real x116 = cosine16[2] * k[3];
    const zd_real x117 = cosine16[0] * k[2];
    const zd_real x118 = k[1] * cosine16[1];
    const zd_real x122 = x116 + (x117 + (x118 - k[0]));
    const zd_real x123 = sine16[2] * k[3];
    const zd_real x124 = k[1] * sine16[1];
    const zd_real x125 = sine16[0] * k[2];
    const zd_real x127 = x123 + (x124 + x125);
    const zd_real x310 = ZD_FMA(v2, x116, ZD_FMA(v1, x117, v0 * x118));
    const zd_real x474 = 1.0 / x117;
    const zd_real x475 = x125 * x474;
    const zd_real x485 = 1.0 / ZD_FMS(x116, x475, x123);
    const zd_real x487 = ZD_FMS(x118, x475, x124) * x485;
    const zd_real x493 = x474 * ZD_FNMA(x116, x487, x118);
    const zd_real x506 = ZD_FNMA(x71, x487, ZD_FNMA(k[15], x493, x36));
    const zd_real x512 = ZD_FNMA(k[18], x487, ZD_FNMA(x71, x493, x53));
    const zd_real x519 = 1.0 / ZD_FNMA(x487, x512, ZD_FNMA(x493, x506, ZD_FNMA(x53, x487, ZD_FNMA(x36, x493, k[11]))));
    const zd_real x523 = x485 * ZD_FMA(x127, x475, x122);
    const zd_real x526 = x474 * ZD_FNMA(x116, x523, x127);
    const zd_real x531 = x519 * ZD_FMA(x512, x523, x506 * x526);
    const zd_real x542 = x485 * ZD_FMS(x310, x475, ZD_FMA(v2, x123, ZD_FMA(v1, x125, v0 * x124)));
    const zd_real x545 = x474 * ZD_FNMA(x116, x542, x310);
    const zd_real x550 = x519 * ZD_FMA(x512, x542, x506 * x545);
    Phi[0] = x122;
    Phi[1] = x127;
    dp[0] = -x531;
    dp[1] = ZD_FMA(x493, x531, x526);
    dp[2] = ZD_FMA(x487, x531, x523);
    dv[0] = -x550;
    dv[1] = ZD_FMA(x493, x550, x545);
    dv[2] = ZD_FMA(x487, x550, x542);
    return ZD_DONE;
}
#endif

#if ZD_LANES == 1
ZD_ON_UNIT static int ZD_NAMED(embed_1)(const zd_elimination *self, const void *data, const double *at_inputs, const double *at_time, const double *at_p,
    double *to_v, const double *with_added, const double *where_allowed, double *to_Phi, double *to_dp,
    double *to_D, double *to_pdot, double *to_vdot, double *to_lambda, double *to_power, double *to_pivots)
{
    const zd_stored *restrict const k = (const zd_stored *)((const double *)data + 14 * ZD_LANES);
    const zd_stored *restrict const input = (const zd_stored *)at_inputs;
    const zd_stored *restrict const time = (const zd_stored *)at_time;
    const zd_stored *restrict const p = (const zd_stored *)at_p;
    const zd_stored *restrict const allowed = (const zd_stored *)where_allowed;
    const zd_stored *restrict const added = (const zd_stored *)with_added;
    zd_stored *restrict const v = (zd_stored *)to_v;
    zd_stored *restrict const Phi = (zd_stored *)to_Phi;
    zd_stored *restrict const dp = (zd_stored *)to_dp;
    zd_stored *restrict const D = (zd_stored *)to_D;
    zd_stored *restrict const pdot = (zd_stored *)to_pdot;
    zd_stored *restrict const vdot = (zd_stored *)to_vdot;
    zd_stored *restrict const lambda = (zd_stored *)to_lambda;
    zd_stored *restrict const power = (zd_stored *)to_power;
    zd_stored *restrict const pivots = (zd_stored *)to_pivots;
    const zd_real t = *time;
    (void)self, (void)t, (void)k, (void)input, (void)time, (void)p, (void)allowed, (void)added, (void)v, (void)Phi, (void)dp, (void)D, (void)pdot, (void)vdot, (void)lambda, (void)power, (void)pivots;
    const zd_real p0 = p[0], p1 = p[1], p2 = p[2];
    const zd_real before0 = v[0], before1 = v[1], before2 = v[2];
    const zd_real added0 = added ? (zd_real)added[0] : ZD_SPLAT(0.0), added1 = added ? (zd_real)added[1] : ZD_SPLAT(0.0);
    /* Phi (3) */
    const zd_real angle16[ZD_PADDED(3)] = {p1, p0, p2};
    zd_real sine16[ZD_PADDED(3)], cosine16[ZD_PADDED(3)];
    ZD_SINES(3, angle16, sine16, cosine16);
    const zd_real x116 = cosine16[2] * k[3];
    const zd_real x117 = cosine16[0] * k[2];
    const zd_real x118 = k[1] * cosine16[1];
    const zd_real x122 = x116 + (x117 + (x118 - k[0]));
    const zd_real x123 = sine16[2] * k[3];
    const zd_real x124 = k[1] * sine16[1];
    const zd_real x125 = sine16[0] * k[2];
    const zd_real x127 = x123 + (x124 + x125);
    Phi[0] = x122;
    Phi[1] = x127;
    if (!(fabs(Phi[0]) <= allowed[0]) || !(fabs(Phi[1]) <= allowed[1])) {
        /* dp (18) */
        const zd_real x474 = 1.0 / x117;
        const zd_real x475 = x125 * x474;
        const zd_real x484 = ZD_FMS(x116, x475, x123);
        const zd_real x485 = 1.0 / x484;
        const zd_real x523 = x485 * ZD_FMA(x127, x475, x122);
        dp[0] = ZD_SPLAT(0.0);
        dp[1] = x474 * ZD_FNMA(x116, x523, x127);
        dp[2] = x523;
        return ZD_NO_CONVERGENCE;
    }
    /* dv (14), (16) */
    const zd_real x385 = ZD_FMA(x116, before2, ZD_FMA(x117, before1, x118 * before0));
    const zd_real x474 = 1.0 / x117;
    const zd_real x475 = x125 * x474;
    const zd_real x484 = ZD_FMS(x116, x475, x123);
    const zd_real x485 = 1.0 / x484;
    const zd_real x561 = x485 * ZD_FMS(x385, x475, ZD_FMA(x123, before2, ZD_FMA(x125, before1, x124 * before0)));
    const zd_real v0 = before0;
    const zd_real v1 = before1 - (x474 * ZD_FNMA(x116, x561, x385));
    const zd_real v2 = before2 - x561;
    /* vdot (17) */
    const zd_real x36 = ZD_FMA(sine16[0], sine16[1], cosine16[0] * cosine16[1]) * k[12];
    const zd_real x44 = ZD_FNMA(cosine16[1], sine16[2], sine16[1] * cosine16[2]);
    const zd_real x53 = ZD_FMA(sine16[1], sine16[2], cosine16[1] * cosine16[2]) * k[14];
    const zd_real x63 = ZD_FNMA(cosine16[0], sine16[2], sine16[0] * cosine16[2]);
    const zd_real x71 = ZD_FMA(sine16[0], sine16[2], cosine16[0] * cosine16[2]) * k[17];
    const zd_real x78 = v1 * v1;
    const zd_real x79 = ZD_FNMA(sine16[0], cosine16[1], cosine16[0] * sine16[1]) * k[12];
    const zd_real x82 = v2 * v2;
    const zd_real x89 = v0 * v0;
    const zd_real x217 = ZD_FMA(x82, x123, ZD_FMA(x78, x125, x89 * x124)) + added1;
    const zd_real x220 = ZD_FMA(cosine16[0], k[20], ZD_FNMA(x79, x89, x82 * (x63 * k[17])));
    const zd_real x222 = ZD_FNMA(cosine16[2], k[21], 0.5 * ZD_FMA(x78, x63 * k[16], x89 * (x44 * k[13])));
    const zd_real x487 = ZD_FMS(x118, x475, x124) * x485;
    const zd_real x493 = x474 * ZD_FNMA(x116, x487, x118);
    const zd_real x506 = ZD_FNMA(x71, x487, ZD_FNMA(k[15], x493, x36));
    const zd_real x512 = ZD_FNMA(k[18], x487, ZD_FNMA(x71, x493, x53));
    const zd_real x568 = x485 * ZD_FMA(x217, x475, ZD_FMA(x82, x116, ZD_FMA(x78, x117, x89 * x118)) + added0);
    const zd_real x571 = x474 * ZD_FNMA(x116, x568, x217);
    const zd_real x581 = ZD_FNMA(x222, x487, ZD_FMS(x220, x493, ZD_FMA(cosine16[1], k[19], ZD_FMA(x82, x44 * k[14], x78 * x79))));
    const zd_real x583 = (1.0 / ZD_FNMA(x487, x512, ZD_FNMA(x493, x506, ZD_FNMA(x53, x487, ZD_FNMA(x36, x493, k[11]))))) * (x581 - ZD_FMA(x512, x568, x506 * x571));
    const zd_real x586 = ZD_FNMA(x493, x583, x571);
    const zd_real x589 = ZD_FNMA(x487, x583, x568);
    v[0] = v0;
    v[1] = v1;
    v[2] = v2;
    vdot[0] = x583;
    vdot[1] = x586;
    vdot[2] = x589;
    /* lambda (8); power (28) */
    if (lambda || power) {
        const zd_real x610 = x474 * (x220 + ZD_FMA(x71, x589, ZD_FMA(k[15], x586, x36 * x583)));
        const zd_real x615 = x485 * ZD_FMA(x116, x610, x222 - ZD_FMA(k[18], x589, ZD_FMA(x71, x586, x53 * x583)));
        if (lambda) lambda[0] = x615;
        if (lambda) lambda[1] = ZD_FMS(x475, x615, x610);
        if (power) power[0] = ZD_SPLAT(0.0);
    }
    /* D (16) */
    if (pivots || D) {
        if (pivots) pivots[0] = x117;
        if (pivots) pivots[1] = x484;
        if (pivots) pivots[2] = ZD_SPLAT(1.0);
        if (D) D[0] = -x493;
        if (D) D[1] = -x487;
    }
    return ZD_DONE;
}
#endif

#if ZD_LANES == 1
#define ZD_FINISH(name) ZD_NAMED(name)
#else
#define ZD_FINISH(name) NULL
#endif
static const zd_elimination ZD_NAMED(orders)[] = {
    {1, solve_0, row_0, column_0, ZD_NAMED(accelerate_0), ZD_NAMED(correct_0), ZD_FINISH(finish_0), NULL, NULL},
};
#undef ZD_FINISH
#if ZD_LANES == 1
static const zd_elimination ZD_NAMED(embeddings)[] = {
    {2, solve_1, row_1, column_1, NULL, ZD_NAMED(correct_1), NULL, ZD_NAMED(embed_1), NULL},
};
#endif

#undef ZD_UNIT
#undef ZD_LANES
#endif
