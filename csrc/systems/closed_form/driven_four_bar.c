/* Written by python/write_closed_form.py with SymPy 1.14.0, from tests/symbolic_counterparts.py. */
#ifndef ZD_LANES
#include "driven_four_bar.h"

#include <math.h>
#include "../../include/zerodrift/units.h"

/* Constants computed from the parameters alone, stored after them. */
void zd_driven_four_bar_closed_form_constants(double *k)
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
static const int solve_1[] = {0, 1, 2};
static const int row_1[] = {2, 1, 0};
static const int column_1[] = {0, 1, 2};

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

const zd_closed_form zd_driven_four_bar_closed_form[] = {
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

ZD_ON_UNIT static int ZD_NAMED(accelerate_0)(const void *data, const double *at_inputs, const double *at_time, const double *at_p,
    const double *at_v, const double *with_added, double *to_pdot, double *to_vdot, double *to_lambda,
    double *to_power, double *to_pivots)
{
    const zd_stored *restrict const k = (const zd_stored *)((const double *)data + 18 * ZD_LANES);
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
    (void)t, (void)k, (void)input, (void)time, (void)p, (void)v, (void)added, (void)pdot, (void)vdot, (void)lambda, (void)power, (void)pivots;
    const zd_real p0 = p[0], p1 = p[1], p2 = p[2];
    const zd_real v0 = v[0], v1 = v[1], v2 = v[2];
    const zd_real added0 = added ? (zd_real)added[0] : ZD_SPLAT(0.0), added1 = added ? (zd_real)added[1] : ZD_SPLAT(0.0), added2 = added ? (zd_real)added[2] : ZD_SPLAT(0.0);
    const zd_real x78 = v1 * v1;
    const zd_real x82 = v2 * v2;
    const zd_real x89 = v0 * v0;
    const zd_real x132 = t * k[14];
    const zd_real angle16[ZD_PADDED(4)] = {p1, p0, p2, x132};
    zd_real sine16[ZD_PADDED(4)], cosine16[ZD_PADDED(4)];
    ZD_SINES(4, angle16, sine16, cosine16);
    const zd_real x116 = cosine16[2] * k[3];
    const zd_real x117 = cosine16[0] * k[2];
    const zd_real x118 = k[1] * cosine16[1];
    const zd_real x123 = sine16[2] * k[3];
    const zd_real x124 = k[1] * sine16[1];
    const zd_real x125 = sine16[0] * k[2];
    const zd_real x167 = ZD_FNMA(x116, x125, x117 * x123);
    const zd_real x168 = 1.0 / x167;
    const zd_real x169 = x116 * x168;
    const zd_real x170 = x123 * x168;
    const zd_real x171 = x117 * x168;
    const zd_real x173 = x125 * x168;
    const zd_real x180 = ZD_FNMA(sine16[3], k[27], added2);
    const zd_real x188 = ZD_FMA(x124, x180, ZD_FMA(x82, x116, ZD_FMA(x78, x117, x89 * x118)) + added0);
    const zd_real x190 = ZD_FNMA(x118, x180, ZD_FMA(x82, x123, ZD_FMA(x78, x125, x89 * x124)) + added1);
    const zd_real x193 = ZD_FMA(x170, x190, x169 * x188);
    const zd_real x198 = ZD_FMA(x173, x190, x171 * x188);
    vdot[0] = x180;
    vdot[1] = x193;
    vdot[2] = -x198;
    if (lambda || power) {
        const zd_real x36 = ZD_FMA(sine16[0], sine16[1], cosine16[0] * cosine16[1]) * k[16];
        const zd_real x44 = ZD_FNMA(cosine16[1], sine16[2], sine16[1] * cosine16[2]);
        const zd_real x53 = ZD_FMA(sine16[1], sine16[2], cosine16[1] * cosine16[2]) * k[18];
        const zd_real x63 = ZD_FNMA(cosine16[0], sine16[2], sine16[0] * cosine16[2]);
        const zd_real x71 = ZD_FMA(sine16[0], sine16[2], cosine16[0] * cosine16[2]) * k[21];
        const zd_real x79 = ZD_FNMA(sine16[0], cosine16[1], cosine16[0] * sine16[1]) * k[16];
        const zd_real x206 = ZD_FMA(cosine16[1], k[23], ZD_FMA(x82, x44 * k[18], x78 * x79)) + ZD_FNMA(x53, x198, ZD_FMA(x36, x193, k[15] * x180));
        const zd_real x214 = ZD_FMA(cosine16[0], k[24], ZD_FNMA(x79, x89, x82 * (x63 * k[21]))) + ZD_FNMA(x71, x198, ZD_FMA(k[19], x193, x36 * x180));
        const zd_real x222 = ZD_FNMA(cosine16[2], k[25], 0.5 * ZD_FMA(x78, x63 * k[20], x89 * (x44 * k[17]))) - ZD_FNMA(k[22], x198, ZD_FMA(x71, x193, x53 * x180));
        const zd_real x227 = ZD_FMA(x171, x222, x169 * x214);
        const zd_real x233 = ZD_FMA(x173, x222, x170 * x214);
        const zd_real x240 = x206 + ZD_FNMA(x118, x233, x124 * x227);
        const zd_real angle143[ZD_PADDED(1)] = {x132};
        zd_real sine143[ZD_PADDED(1)], cosine143[ZD_PADDED(1)];
        ZD_SINES(1, angle143, sine143, cosine143);
        if (lambda) lambda[0] = -x227;
        if (lambda) lambda[1] = -x233;
        if (lambda) lambda[2] = -x240;
        if (power) power[0] = ZD_FMA(cosine143[0], k[26], k[12]) * x240;
    }
    if (pivots) {
        pivots[0] = ZD_SPLAT(1.0);
        pivots[1] = x167;
    }
    return ZD_DONE;
}

ZD_ON_UNIT static int ZD_NAMED(correct_0)(const void *data, const double *at_inputs, const double *at_time, const double *at_p,
    const double *at_v, double *to_Phi, double *to_dp, double *to_dv)
{
    const zd_stored *restrict const k = (const zd_stored *)((const double *)data + 18 * ZD_LANES);
    const zd_stored *restrict const input = (const zd_stored *)at_inputs;
    const zd_stored *restrict const time = (const zd_stored *)at_time;
    const zd_stored *restrict const p = (const zd_stored *)at_p;
    const zd_stored *restrict const v = (const zd_stored *)at_v;
    zd_stored *restrict const Phi = (zd_stored *)to_Phi;
    zd_stored *restrict const dp = (zd_stored *)to_dp;
    zd_stored *restrict const dv = (zd_stored *)to_dv;
    const zd_real t = *time;
    (void)t, (void)k, (void)input, (void)time, (void)p, (void)v, (void)Phi, (void)dp, (void)dv;
    const zd_real p0 = p[0], p1 = p[1], p2 = p[2];
    const zd_real v0 = v[0], v1 = v[1], v2 = v[2];
    const zd_real x132 = t * k[14];
    const zd_real angle16[ZD_PADDED(4)] = {p1, p0, p2, x132};
    zd_real sine16[ZD_PADDED(4)], cosine16[ZD_PADDED(4)];
    ZD_SINES(4, angle16, sine16, cosine16);
    const zd_real x116 = cosine16[2] * k[3];
    const zd_real x117 = cosine16[0] * k[2];
    const zd_real x118 = k[1] * cosine16[1];
    const zd_real x122 = x116 + (x117 + (x118 - k[0]));
    const zd_real x123 = sine16[2] * k[3];
    const zd_real x124 = k[1] * sine16[1];
    const zd_real x125 = sine16[0] * k[2];
    const zd_real x127 = x123 + (x124 + x125);
    const zd_real x139 = ZD_FNMA(t, k[12], ZD_FNMA(sine16[3], k[13], p0 - k[11]));
    const zd_real x168 = 1.0 / ZD_FNMA(x116, x125, x117 * x123);
    const zd_real x169 = x116 * x168;
    const zd_real x170 = x123 * x168;
    const zd_real x171 = x117 * x168;
    const zd_real x173 = x125 * x168;
    const zd_real x259 = v0 - ZD_FMA(cosine16[3], k[26], k[12]);
    const zd_real x262 = ZD_FMA(x124, x139, x122);
    const zd_real x264 = ZD_FNMA(x118, x139, x127);
    const zd_real x276 = ZD_FMS(x124, x259, ZD_FMA(v2, x123, ZD_FMA(v1, x125, v0 * x124)));
    const zd_real x278 = ZD_FNMA(x118, x259, ZD_FMA(v2, x116, ZD_FMA(v1, x117, v0 * x118)));
    Phi[0] = x122;
    Phi[1] = x127;
    Phi[2] = x139;
    dp[0] = x139;
    dp[1] = ZD_FMA(x170, x264, x169 * x262);
    dp[2] = -ZD_FMA(x173, x264, x171 * x262);
    dv[0] = x259;
    dv[1] = ZD_FMA(x170, x278, x169 * x276);
    dv[2] = -ZD_FMA(x173, x278, x171 * x276);
    return ZD_DONE;
}

#if ZD_LANES == 1
ZD_ON_UNIT static int ZD_NAMED(finish_0)(const void *data, const double *at_inputs, const double *at_time, const double *at_p,
    double *to_v, const double *where_allowed, double *to_Phi, double *to_dp, double *to_pdot, double *to_vdot,
    double *to_lambda, double *to_power, double *to_pivots)
{
    const zd_stored *restrict const k = (const zd_stored *)((const double *)data + 18 * ZD_LANES);
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
    (void)t, (void)k, (void)input, (void)time, (void)p, (void)allowed, (void)v, (void)Phi, (void)dp, (void)pdot, (void)vdot, (void)lambda, (void)power, (void)pivots;
    const zd_real p0 = p[0], p1 = p[1], p2 = p[2];
    const zd_real before0 = v[0], before1 = v[1], before2 = v[2];
    const zd_real x132 = t * k[14];
    const zd_real angle16[ZD_PADDED(4)] = {p1, p0, p2, x132};
    zd_real sine16[ZD_PADDED(4)], cosine16[ZD_PADDED(4)];
    ZD_SINES(4, angle16, sine16, cosine16);
    const zd_real x116 = cosine16[2] * k[3];
    const zd_real x117 = cosine16[0] * k[2];
    const zd_real x118 = k[1] * cosine16[1];
    const zd_real x122 = x116 + (x117 + (x118 - k[0]));
    const zd_real x123 = sine16[2] * k[3];
    const zd_real x124 = k[1] * sine16[1];
    const zd_real x125 = sine16[0] * k[2];
    const zd_real x127 = x123 + (x124 + x125);
    const zd_real x139 = ZD_FNMA(t, k[12], ZD_FNMA(sine16[3], k[13], p0 - k[11]));
    Phi[0] = x122;
    Phi[1] = x127;
    Phi[2] = x139;
    if (!(fabs(Phi[0]) <= allowed[0]) || !(fabs(Phi[1]) <= allowed[1]) || !(fabs(Phi[2]) <= allowed[2])) {
        const zd_real x167 = ZD_FNMA(x116, x125, x117 * x123);
        const zd_real x168 = 1.0 / x167;
        const zd_real x169 = x116 * x168;
        const zd_real x170 = x123 * x168;
        const zd_real x171 = x117 * x168;
        const zd_real x173 = x125 * x168;
        const zd_real x262 = ZD_FMA(x124, x139, x122);
        const zd_real x264 = ZD_FNMA(x118, x139, x127);
        dp[0] = x139;
        dp[1] = ZD_FMA(x170, x264, x169 * x262);
        dp[2] = -ZD_FMA(x173, x264, x171 * x262);
        return ZD_NO_CONVERGENCE;
    }
    const zd_real x167 = ZD_FNMA(x116, x125, x117 * x123);
    const zd_real x168 = 1.0 / x167;
    const zd_real x169 = x116 * x168;
    const zd_real x170 = x123 * x168;
    const zd_real x171 = x117 * x168;
    const zd_real x173 = x125 * x168;
    const zd_real angle143[ZD_PADDED(1)] = {x132};
    zd_real sine143[ZD_PADDED(1)], cosine143[ZD_PADDED(1)];
    ZD_SINES(1, angle143, sine143, cosine143);
    const zd_real x146 = ZD_FMA(cosine143[0], k[26], k[12]);
    const zd_real x306 = before0 - x146;
    const zd_real x309 = ZD_FMS(x124, x306, ZD_FMA(x123, before2, ZD_FMA(x125, before1, x124 * before0)));
    const zd_real x311 = ZD_FNMA(x118, x306, ZD_FMA(x116, before2, ZD_FMA(x117, before1, x118 * before0)));
    const zd_real v0 = before0 - x306;
    const zd_real v1 = before1 - ZD_FMA(x170, x311, x169 * x309);
    const zd_real v2 = before2 - (-ZD_FMA(x173, x311, x171 * x309));
    const zd_real x78 = v1 * v1;
    const zd_real x82 = v2 * v2;
    const zd_real x89 = v0 * v0;
    const zd_real x160 = sine16[3] * k[27];
    const zd_real x323 = ZD_FNMA(x124, x160, ZD_FMA(x82, x116, ZD_FMA(x78, x117, x89 * x118)));
    const zd_real x326 = ZD_FMA(x118, x160, ZD_FMA(x82, x123, ZD_FMA(x78, x125, x89 * x124)));
    const zd_real x329 = ZD_FMA(x170, x326, x169 * x323);
    const zd_real x334 = ZD_FMA(x173, x326, x171 * x323);
    v[0] = v0;
    v[1] = v1;
    v[2] = v2;
    vdot[0] = -x160;
    vdot[1] = x329;
    vdot[2] = -x334;
    if (lambda || power) {
        const zd_real x36 = ZD_FMA(sine16[0], sine16[1], cosine16[0] * cosine16[1]) * k[16];
        const zd_real x44 = ZD_FNMA(cosine16[1], sine16[2], sine16[1] * cosine16[2]);
        const zd_real x53 = ZD_FMA(sine16[1], sine16[2], cosine16[1] * cosine16[2]) * k[18];
        const zd_real x63 = ZD_FNMA(cosine16[0], sine16[2], sine16[0] * cosine16[2]);
        const zd_real x71 = ZD_FMA(sine16[0], sine16[2], cosine16[0] * cosine16[2]) * k[21];
        const zd_real x79 = ZD_FNMA(sine16[0], cosine16[1], cosine16[0] * sine16[1]) * k[16];
        const zd_real x343 = ZD_FMA(cosine16[1], k[23], ZD_FMA(x82, x44 * k[18], x78 * x79)) + ZD_FNMA(x53, x334, ZD_FNMA(k[15], x160, x36 * x329));
        const zd_real x352 = ZD_FMA(cosine16[0], k[24], ZD_FNMA(x79, x89, x82 * (x63 * k[21]))) + ZD_FNMA(x71, x334, ZD_FNMA(x36, x160, k[19] * x329));
        const zd_real x361 = ZD_FNMA(cosine16[2], k[25], 0.5 * ZD_FMA(x78, x63 * k[20], x89 * (x44 * k[17]))) - ZD_FNMA(k[22], x334, ZD_FNMA(x53, x160, x71 * x329));
        const zd_real x366 = ZD_FMA(x171, x361, x169 * x352);
        const zd_real x372 = ZD_FMA(x173, x361, x170 * x352);
        const zd_real x379 = x343 + ZD_FNMA(x118, x372, x124 * x366);
        if (lambda) lambda[0] = -x366;
        if (lambda) lambda[1] = -x372;
        if (lambda) lambda[2] = -x379;
        if (power) power[0] = x146 * x379;
    }
    if (pivots) {
        pivots[0] = ZD_SPLAT(1.0);
        pivots[1] = x167;
    }
    return ZD_DONE;
}
#endif

#if ZD_LANES == 1
ZD_ON_UNIT static int ZD_NAMED(correct_1)(const void *data, const double *at_inputs, const double *at_time, const double *at_p,
    const double *at_v, double *to_Phi, double *to_dp, double *to_dv)
{
    const zd_stored *restrict const k = (const zd_stored *)((const double *)data + 18 * ZD_LANES);
    const zd_stored *restrict const input = (const zd_stored *)at_inputs;
    const zd_stored *restrict const time = (const zd_stored *)at_time;
    const zd_stored *restrict const p = (const zd_stored *)at_p;
    const zd_stored *restrict const v = (const zd_stored *)at_v;
    zd_stored *restrict const Phi = (zd_stored *)to_Phi;
    zd_stored *restrict const dp = (zd_stored *)to_dp;
    zd_stored *restrict const dv = (zd_stored *)to_dv;
    const zd_real t = *time;
    (void)t, (void)k, (void)input, (void)time, (void)p, (void)v, (void)Phi, (void)dp, (void)dv;
    const zd_real p0 = p[0], p1 = p[1], p2 = p[2];
    const zd_real v0 = v[0], v1 = v[1], v2 = v[2];
    const zd_real x132 = t * k[14];
    const zd_real angle16[ZD_PADDED(4)] = {p1, p0, p2, x132};
    zd_real sine16[ZD_PADDED(4)], cosine16[ZD_PADDED(4)];
    ZD_SINES(4, angle16, sine16, cosine16);
    const zd_real x116 = cosine16[2] * k[3];
    const zd_real x117 = cosine16[0] * k[2];
    const zd_real x118 = k[1] * cosine16[1];
    const zd_real x122 = x116 + (x117 + (x118 - k[0]));
    const zd_real x123 = sine16[2] * k[3];
    const zd_real x124 = k[1] * sine16[1];
    const zd_real x125 = sine16[0] * k[2];
    const zd_real x127 = x123 + (x124 + x125);
    const zd_real x139 = ZD_FNMA(t, k[12], ZD_FNMA(sine16[3], k[13], p0 - k[11]));
    const zd_real x259 = v0 - ZD_FMA(cosine16[3], k[26], k[12]);
    const zd_real x264 = ZD_FNMA(x118, x139, x127);
    const zd_real x278 = ZD_FNMA(x118, x259, ZD_FMA(v2, x116, ZD_FMA(v1, x117, v0 * x118)));
    const zd_real x383 = 1.0 / x117;
    const zd_real x384 = x125 * x383;
    const zd_real x391 = 1.0 / ZD_FMS(x116, x384, x123);
    const zd_real x395 = x391 * ZD_FMA(x264, x384, ZD_FMA(x124, x139, x122));
    const zd_real x402 = x391 * ZD_FMA(x278, x384, ZD_FMS(x124, x259, ZD_FMA(v2, x123, ZD_FMA(v1, x125, v0 * x124))));
    Phi[0] = x122;
    Phi[1] = x127;
    Phi[2] = x139;
    dp[0] = x139;
    dp[1] = x383 * ZD_FNMA(x116, x395, x264);
    dp[2] = x395;
    dv[0] = x259;
    dv[1] = x383 * ZD_FNMA(x116, x402, x278);
    dv[2] = x402;
    return ZD_DONE;
}
#endif

#if ZD_LANES == 1
ZD_ON_UNIT static int ZD_NAMED(embed_1)(const void *data, const double *at_inputs, const double *at_time, const double *at_p,
    double *to_v, const double *with_added, const double *where_allowed, double *to_Phi, double *to_dp,
    double *to_D, double *to_pdot, double *to_vdot, double *to_lambda, double *to_power, double *to_pivots)
{
    const zd_stored *restrict const k = (const zd_stored *)((const double *)data + 18 * ZD_LANES);
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
    (void)t, (void)k, (void)input, (void)time, (void)p, (void)allowed, (void)added, (void)v, (void)Phi, (void)dp, (void)D, (void)pdot, (void)vdot, (void)lambda, (void)power, (void)pivots;
    const zd_real p0 = p[0], p1 = p[1], p2 = p[2];
    const zd_real before0 = v[0], before1 = v[1], before2 = v[2];
    const zd_real added0 = added ? (zd_real)added[0] : ZD_SPLAT(0.0), added1 = added ? (zd_real)added[1] : ZD_SPLAT(0.0), added2 = added ? (zd_real)added[2] : ZD_SPLAT(0.0);
    const zd_real x132 = t * k[14];
    const zd_real angle16[ZD_PADDED(4)] = {p1, p0, p2, x132};
    zd_real sine16[ZD_PADDED(4)], cosine16[ZD_PADDED(4)];
    ZD_SINES(4, angle16, sine16, cosine16);
    const zd_real x116 = cosine16[2] * k[3];
    const zd_real x117 = cosine16[0] * k[2];
    const zd_real x118 = k[1] * cosine16[1];
    const zd_real x122 = x116 + (x117 + (x118 - k[0]));
    const zd_real x123 = sine16[2] * k[3];
    const zd_real x124 = k[1] * sine16[1];
    const zd_real x125 = sine16[0] * k[2];
    const zd_real x127 = x123 + (x124 + x125);
    const zd_real x139 = ZD_FNMA(t, k[12], ZD_FNMA(sine16[3], k[13], p0 - k[11]));
    Phi[0] = x122;
    Phi[1] = x127;
    Phi[2] = x139;
    if (!(fabs(Phi[0]) <= allowed[0]) || !(fabs(Phi[1]) <= allowed[1]) || !(fabs(Phi[2]) <= allowed[2])) {
        const zd_real x264 = ZD_FNMA(x118, x139, x127);
        const zd_real x383 = 1.0 / x117;
        const zd_real x384 = x125 * x383;
        const zd_real x390 = ZD_FMS(x116, x384, x123);
        const zd_real x391 = 1.0 / x390;
        const zd_real x395 = x391 * ZD_FMA(x264, x384, ZD_FMA(x124, x139, x122));
        dp[0] = x139;
        dp[1] = x383 * ZD_FNMA(x116, x395, x264);
        dp[2] = x395;
        return ZD_NO_CONVERGENCE;
    }
    const zd_real x383 = 1.0 / x117;
    const zd_real x384 = x125 * x383;
    const zd_real x390 = ZD_FMS(x116, x384, x123);
    const zd_real x391 = 1.0 / x390;
    const zd_real angle143[ZD_PADDED(1)] = {x132};
    zd_real sine143[ZD_PADDED(1)], cosine143[ZD_PADDED(1)];
    ZD_SINES(1, angle143, sine143, cosine143);
    const zd_real x146 = ZD_FMA(cosine143[0], k[26], k[12]);
    const zd_real x306 = before0 - x146;
    const zd_real x311 = ZD_FNMA(x118, x306, ZD_FMA(x116, before2, ZD_FMA(x117, before1, x118 * before0)));
    const zd_real x408 = ZD_FMA(x311, x384, ZD_FMS(x124, x306, ZD_FMA(x123, before2, ZD_FMA(x125, before1, x124 * before0))));
    const zd_real x409 = x391 * x408;
    const zd_real v0 = before0 - x306;
    const zd_real v1 = before1 - (x383 * ZD_FNMA(x116, x409, x311));
    const zd_real v2 = before2 - x409;
    const zd_real x78 = v1 * v1;
    const zd_real x82 = v2 * v2;
    const zd_real x89 = v0 * v0;
    const zd_real x180 = ZD_FNMA(sine16[3], k[27], added2);
    const zd_real x190 = ZD_FNMA(x118, x180, ZD_FMA(x82, x123, ZD_FMA(x78, x125, x89 * x124)) + added1);
    const zd_real x416 = x391 * ZD_FMA(x190, x384, ZD_FMA(x124, x180, ZD_FMA(x82, x116, ZD_FMA(x78, x117, x89 * x118)) + added0));
    const zd_real x419 = x383 * ZD_FNMA(x116, x416, x190);
    v[0] = v0;
    v[1] = v1;
    v[2] = v2;
    vdot[0] = x180;
    vdot[1] = x419;
    vdot[2] = x416;
    if (lambda || power) {
        const zd_real x36 = ZD_FMA(sine16[0], sine16[1], cosine16[0] * cosine16[1]) * k[16];
        const zd_real x44 = ZD_FNMA(cosine16[1], sine16[2], sine16[1] * cosine16[2]);
        const zd_real x53 = ZD_FMA(sine16[1], sine16[2], cosine16[1] * cosine16[2]) * k[18];
        const zd_real x63 = ZD_FNMA(cosine16[0], sine16[2], sine16[0] * cosine16[2]);
        const zd_real x71 = ZD_FMA(sine16[0], sine16[2], cosine16[0] * cosine16[2]) * k[21];
        const zd_real x79 = ZD_FNMA(sine16[0], cosine16[1], cosine16[0] * sine16[1]) * k[16];
        const zd_real x424 = ZD_FMA(cosine16[1], k[23], ZD_FMA(x82, x44 * k[18], x78 * x79)) + ZD_FMA(x53, x416, ZD_FMA(x36, x419, k[15] * x180));
        const zd_real x430 = ZD_FMA(cosine16[0], k[24], ZD_FNMA(x79, x89, x82 * (x63 * k[21]))) + ZD_FMA(x71, x416, ZD_FMA(k[19], x419, x36 * x180));
        const zd_real x436 = ZD_FNMA(cosine16[2], k[25], 0.5 * ZD_FMA(x78, x63 * k[20], x89 * (x44 * k[17]))) - ZD_FMA(k[22], x416, ZD_FMA(x71, x419, x53 * x180));
        const zd_real x437 = x383 * x430;
        const zd_real x442 = x391 * ZD_FMA(x116, x437, x436);
        const zd_real x445 = ZD_FMS(x384, x442, x437);
        const zd_real x450 = x424 + ZD_FNMA(x124, x442, x118 * x445);
        if (lambda) lambda[0] = x442;
        if (lambda) lambda[1] = x445;
        if (lambda) lambda[2] = -x450;
        if (power) power[0] = x146 * x450;
    }
    if (pivots) {
        pivots[0] = ZD_SPLAT(1.0);
        pivots[1] = x117;
        pivots[2] = x390;
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
    {2, solve_0, row_0, column_0, ZD_NAMED(accelerate_0), ZD_NAMED(correct_0), ZD_FINISH(finish_0), NULL},
};
#undef ZD_FINISH
#if ZD_LANES == 1
static const zd_elimination ZD_NAMED(embeddings)[] = {
    {3, solve_1, row_1, column_1, NULL, ZD_NAMED(correct_1), NULL, ZD_NAMED(embed_1)},
};
#endif

#undef ZD_UNIT
#undef ZD_LANES
#endif
