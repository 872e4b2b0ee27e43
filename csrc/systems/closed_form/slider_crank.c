/* Written by python/write_closed_form.py with SymPy 1.14.0, from tests/symbolic_counterparts.py. */
#ifndef ZD_LANES
#include "slider_crank.h"

#include <math.h>
#include "../../include/zerodrift/units.h"

/* Constants computed from the parameters alone, stored after them. */
void zd_slider_crank_closed_form_constants(double *k)
{
    k[11] = 0.5 * k[5];
    k[12] = k[1] * k[8];
}

static const int solve_0[] = {0, 0};
static const int row_0[] = {0, 1};
static const int column_0[] = {1, 2};
static const int solve_1[] = {0, 1};
static const int row_1[] = {0, 1};
static const int column_1[] = {1, 2};

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

const zd_closed_form zd_slider_crank_closed_form[] = {
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
    const zd_stored *restrict const k = (const zd_stored *)(data);
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
    const zd_real added0 = added ? (zd_real)added[0] : ZD_SPLAT(0.0), added1 = added ? (zd_real)added[1] : ZD_SPLAT(0.0);
    const zd_real x95 = v0 * v0;
    const zd_real x97 = v2 * v2;
    const zd_real angle8[ZD_PADDED(2)] = {p0, p2};
    zd_real sine8[ZD_PADDED(2)], cosine8[ZD_PADDED(2)];
    ZD_SINES(2, angle8, sine8, cosine8);
    const zd_real x10 = sine8[0] * k[0];
    const zd_real x14 = sine8[1] * k[1];
    const zd_real x17 = -(0.5 * (x10 + x14));
    const zd_real x19 = k[0] * cosine8[0];
    const zd_real x23 = k[1] * cosine8[1];
    const zd_real x30 = x19 + x23;
    const zd_real x32 = ZD_FNMA(0.5, x30, p1);
    const zd_real x42 = 0.5 * ZD_FMA(x32, ZD_FMA(x14, v2, ZD_FMA(x10, v0, v1 * 2.0)), x17 * (-ZD_FMA(x23, v2, x19 * v0)));
    const zd_real x46 = k[0] * ZD_FNMA(x17, cosine8[0], sine8[0] * x32);
    const zd_real x47 = 0.5 * x46;
    const zd_real x53 = ZD_FMA(x32, x32, x17 * x17);
    const zd_real x55 = ZD_SQRT(x53);
    const zd_real x57 = x55 - k[7];
    const zd_real x68 = x57 * k[11];
    const zd_real x75 = (k[8] - ((ZD_FMS(p1, 2.0, x30) * x68) / x55)) - ((x42 * (x32 * k[6])) / x53);
    const zd_real x79 = k[1] * ZD_FNMA(x17, cosine8[1], sine8[1] * x32);
    const zd_real x80 = 0.5 * x79;
    const zd_real x89 = ((x42 * (k[6] * x80)) / x53) + ZD_FMA(sine8[1], k[12], (x68 * x79) / x55);
    const zd_real x141 = ZD_FNMA(x14, x19, x10 * x23);
    const zd_real x144 = k[3] * x141;
    const zd_real x145 = k[4] * x19;
    const zd_real x151 = ZD_FMA(x19, x145, ZD_FMA(x141, x144, x23 * (k[2] * x23)));
    const zd_real x154 = 1.0 / (x23 * x151);
    const zd_real x156 = x151 * x154;
    const zd_real x163 = added1 - ZD_FMA(x14, x97, x10 * x95);
    const zd_real x168 = ZD_FMA(x14, x163, x23 * (added0 - ZD_FMA(x23, x97, x19 * x95)));
    const zd_real x181 = ZD_FNMA(x19, x89, ZD_FMA(x75, x141, x23 * (((x42 * (x47 * k[6])) / x53) + ((x57 * (x46 * k[11])) / x55))));
    const zd_real x186 = (x23 * x154) * ZD_FMA(x23, x181, ZD_FNMA(x144, x168, x145 * x163));
    const zd_real x198 = ZD_FMA(x186, x141 * x156, x156 * x168);
    const zd_real x205 = ZD_FNMA(x156, x163, x186 * (x19 * x156));
    vdot[0] = -x186;
    vdot[1] = x198;
    vdot[2] = x205;
    if (lambda || power) {
        const zd_real x210 = ZD_FNMA(k[3], x198, x75);
        if (lambda) lambda[0] = x156 * (x23 * x210);
        if (lambda) lambda[1] = x156 * ZD_FMA(x14, x210, ZD_FMA(k[4], x205, x89));
        if (power) power[0] = -(x42 * ((k[6] * ZD_FMA(v2, x80, ZD_FMA(x32, v1, v0 * x47))) / x53));
    }
    if (pivots) {
        pivots[0] = -x23;
        pivots[1] = ZD_SPLAT(1.0);
    }
    return ZD_DONE;
}

ZD_ON_UNIT static int ZD_NAMED(correct_0)(const void *data, const double *at_inputs, const double *at_time, const double *at_p,
    const double *at_v, double *to_Phi, double *to_dp, double *to_dv)
{
    const zd_stored *restrict const k = (const zd_stored *)(data);
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
    const zd_real angle8[ZD_PADDED(2)] = {p0, p2};
    zd_real sine8[ZD_PADDED(2)], cosine8[ZD_PADDED(2)];
    ZD_SINES(2, angle8, sine8, cosine8);
    const zd_real x10 = sine8[0] * k[0];
    const zd_real x14 = sine8[1] * k[1];
    const zd_real x15 = x10 + x14;
    const zd_real x19 = k[0] * cosine8[0];
    const zd_real x23 = k[1] * cosine8[1];
    const zd_real x26 = ZD_FMA(x23, v2, x19 * v0);
    const zd_real x91 = p1 - (x19 + x23);
    const zd_real x141 = ZD_FNMA(x14, x19, x10 * x23);
    const zd_real x144 = k[3] * x141;
    const zd_real x145 = k[4] * x19;
    const zd_real x151 = ZD_FMA(x19, x145, ZD_FMA(x141, x144, x23 * (k[2] * x23)));
    const zd_real x154 = 1.0 / (x23 * x151);
    const zd_real x156 = x151 * x154;
    const zd_real x194 = x141 * x156;
    const zd_real x201 = x19 * x156;
    const zd_real x232 = ZD_FNMA(x23, x91, x14 * x15);
    const zd_real x240 = x154 * (x23 * ZD_FNMA(x15, x145, x144 * x232));
    const zd_real x258 = ZD_FNMA(x23, ZD_FMA(x14, v2, ZD_FMA(x10, v0, v1)), x14 * x26);
    const zd_real x266 = x154 * (x23 * ZD_FNMA(x26, x145, x144 * x258));
    Phi[0] = x91;
    Phi[1] = -x15;
    dp[0] = -x240;
    dp[1] = ZD_FNMA(x156, x232, x194 * x240);
    dp[2] = ZD_FMA(x201, x240, x15 * x156);
    dv[0] = -x266;
    dv[1] = ZD_FNMA(x156, x258, x194 * x266);
    dv[2] = ZD_FMA(x201, x266, x26 * x156);
    return ZD_DONE;
}

#if ZD_LANES == 1
ZD_ON_UNIT static int ZD_NAMED(finish_0)(const void *data, const double *at_inputs, const double *at_time, const double *at_p,
    double *to_v, const double *where_allowed, double *to_Phi, double *to_dp, double *to_pdot, double *to_vdot,
    double *to_lambda, double *to_power, double *to_pivots)
{
    const zd_stored *restrict const k = (const zd_stored *)(data);
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
    const zd_real angle8[ZD_PADDED(2)] = {p0, p2};
    zd_real sine8[ZD_PADDED(2)], cosine8[ZD_PADDED(2)];
    ZD_SINES(2, angle8, sine8, cosine8);
    const zd_real x10 = sine8[0] * k[0];
    const zd_real x14 = sine8[1] * k[1];
    const zd_real x15 = x10 + x14;
    const zd_real x19 = k[0] * cosine8[0];
    const zd_real x23 = k[1] * cosine8[1];
    const zd_real x30 = x19 + x23;
    const zd_real x91 = p1 - x30;
    Phi[0] = x91;
    Phi[1] = -x15;
    if (!(fabs(Phi[0]) <= allowed[0]) || !(fabs(Phi[1]) <= allowed[1])) {
        const zd_real x141 = ZD_FNMA(x14, x19, x10 * x23);
        const zd_real x144 = k[3] * x141;
        const zd_real x145 = k[4] * x19;
        const zd_real x151 = ZD_FMA(x19, x145, ZD_FMA(x141, x144, x23 * (k[2] * x23)));
        const zd_real x154 = 1.0 / (x23 * x151);
        const zd_real x156 = x151 * x154;
        const zd_real x194 = x141 * x156;
        const zd_real x201 = x19 * x156;
        const zd_real x232 = ZD_FNMA(x23, x91, x14 * x15);
        const zd_real x240 = x154 * (x23 * ZD_FNMA(x15, x145, x144 * x232));
        dp[0] = -x240;
        dp[1] = ZD_FNMA(x156, x232, x194 * x240);
        dp[2] = ZD_FMA(x201, x240, x15 * x156);
        return ZD_NO_CONVERGENCE;
    }
    const zd_real x141 = ZD_FNMA(x14, x19, x10 * x23);
    const zd_real x144 = k[3] * x141;
    const zd_real x145 = k[4] * x19;
    const zd_real x151 = ZD_FMA(x19, x145, ZD_FMA(x141, x144, x23 * (k[2] * x23)));
    const zd_real x154 = 1.0 / (x23 * x151);
    const zd_real x156 = x151 * x154;
    const zd_real x194 = x141 * x156;
    const zd_real x201 = x19 * x156;
    const zd_real x291 = ZD_FMA(x23, before2, x19 * before0);
    const zd_real x297 = ZD_FNMA(x23, ZD_FMA(x14, before2, ZD_FMA(x10, before0, before1)), x14 * x291);
    const zd_real x305 = x154 * (x23 * ZD_FNMA(x145, x291, x144 * x297));
    const zd_real v0 = before0 - (-x305);
    const zd_real v1 = before1 - ZD_FNMA(x156, x297, x194 * x305);
    const zd_real v2 = before2 - ZD_FMA(x201, x305, x156 * x291);
    const zd_real x17 = -(0.5 * x15);
    const zd_real x32 = ZD_FNMA(0.5, x30, p1);
    const zd_real x42 = 0.5 * ZD_FMA(x32, ZD_FMA(x14, v2, ZD_FMA(x10, v0, v1 * 2.0)), x17 * (-ZD_FMA(x23, v2, x19 * v0)));
    const zd_real x46 = k[0] * ZD_FNMA(x17, cosine8[0], sine8[0] * x32);
    const zd_real x47 = 0.5 * x46;
    const zd_real x53 = ZD_FMA(x32, x32, x17 * x17);
    const zd_real x55 = ZD_SQRT(x53);
    const zd_real x57 = x55 - k[7];
    const zd_real x68 = x57 * k[11];
    const zd_real x75 = (k[8] - ((ZD_FMS(p1, 2.0, x30) * x68) / x55)) - ((x42 * (x32 * k[6])) / x53);
    const zd_real x79 = k[1] * ZD_FNMA(x17, cosine8[1], sine8[1] * x32);
    const zd_real x80 = 0.5 * x79;
    const zd_real x89 = ((x42 * (k[6] * x80)) / x53) + ZD_FMA(sine8[1], k[12], (x68 * x79) / x55);
    const zd_real x95 = v0 * v0;
    const zd_real x97 = v2 * v2;
    const zd_real x103 = ZD_FMA(x14, x97, x10 * x95);
    const zd_real x181 = ZD_FNMA(x19, x89, ZD_FMA(x75, x141, x23 * (((x42 * (x47 * k[6])) / x53) + ((x57 * (x46 * k[11])) / x55))));
    const zd_real x323 = ZD_FMA(x14, x103, x23 * ZD_FMA(x23, x97, x19 * x95));
    const zd_real x331 = (x23 * x154) * ZD_FMA(x23, x181, ZD_FNMA(x103, x145, x144 * x323));
    const zd_real x339 = ZD_FNMA(x156, x323, x194 * x331);
    const zd_real x344 = ZD_FMA(x201, x331, x103 * x156);
    v[0] = v0;
    v[1] = v1;
    v[2] = v2;
    vdot[0] = -x331;
    vdot[1] = x339;
    vdot[2] = x344;
    if (lambda || power) {
        const zd_real x349 = ZD_FNMA(k[3], x339, x75);
        if (lambda) lambda[0] = x156 * (x23 * x349);
        if (lambda) lambda[1] = x156 * ZD_FMA(x14, x349, ZD_FMA(k[4], x344, x89));
        if (power) power[0] = -(x42 * ((k[6] * ZD_FMA(v2, x80, ZD_FMA(x32, v1, v0 * x47))) / x53));
    }
    if (pivots) {
        pivots[0] = -x23;
        pivots[1] = ZD_SPLAT(1.0);
    }
    return ZD_DONE;
}
#endif

#if ZD_LANES == 1
ZD_ON_UNIT static int ZD_NAMED(correct_1)(const void *data, const double *at_inputs, const double *at_time, const double *at_p,
    const double *at_v, double *to_Phi, double *to_dp, double *to_dv)
{
    const zd_stored *restrict const k = (const zd_stored *)(data);
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
    const zd_real angle8[ZD_PADDED(2)] = {p0, p2};
    zd_real sine8[ZD_PADDED(2)], cosine8[ZD_PADDED(2)];
    ZD_SINES(2, angle8, sine8, cosine8);
    const zd_real x10 = sine8[0] * k[0];
    const zd_real x14 = sine8[1] * k[1];
    const zd_real x15 = x10 + x14;
    const zd_real x19 = k[0] * cosine8[0];
    const zd_real x23 = k[1] * cosine8[1];
    const zd_real x91 = p1 - (x19 + x23);
    const zd_real x115 = 1.0 / x23;
    const zd_real x126 = x19 * x115;
    const zd_real x129 = k[4] * x126;
    const zd_real x365 = ZD_FNMA(x14, x126, x10);
    const zd_real x367 = k[3] * x365;
    const zd_real x373 = 1.0 / ZD_FMA(x126, x129, ZD_FMA(x365, x367, k[2]));
    const zd_real x374 = x15 * x115;
    const zd_real x377 = ZD_FNMA(x14, x374, x91);
    const zd_real x384 = x373 * ZD_FMA(x129, x374, x367 * x377);
    const zd_real x391 = ZD_FMA(x23, v2, x19 * v0) * x115;
    const zd_real x394 = ZD_FNMA(x14, x391, ZD_FMA(x14, v2, ZD_FMA(x10, v0, v1)));
    const zd_real x401 = x373 * ZD_FMA(x129, x391, x367 * x394);
    Phi[0] = x91;
    Phi[1] = -x15;
    dp[0] = x384;
    dp[1] = ZD_FNMA(x365, x384, x377);
    dp[2] = ZD_FNMA(x126, x384, x374);
    dv[0] = x401;
    dv[1] = ZD_FNMA(x365, x401, x394);
    dv[2] = ZD_FNMA(x126, x401, x391);
    return ZD_DONE;
}
#endif

#if ZD_LANES == 1
ZD_ON_UNIT static int ZD_NAMED(embed_1)(const void *data, const double *at_inputs, const double *at_time, const double *at_p,
    double *to_v, const double *with_added, const double *where_allowed, double *to_Phi, double *to_dp,
    double *to_D, double *to_pdot, double *to_vdot, double *to_lambda, double *to_power, double *to_pivots)
{
    const zd_stored *restrict const k = (const zd_stored *)(data);
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
    const zd_real added0 = added ? (zd_real)added[0] : ZD_SPLAT(0.0), added1 = added ? (zd_real)added[1] : ZD_SPLAT(0.0);
    const zd_real angle8[ZD_PADDED(2)] = {p0, p2};
    zd_real sine8[ZD_PADDED(2)], cosine8[ZD_PADDED(2)];
    ZD_SINES(2, angle8, sine8, cosine8);
    const zd_real x10 = sine8[0] * k[0];
    const zd_real x14 = sine8[1] * k[1];
    const zd_real x15 = x10 + x14;
    const zd_real x19 = k[0] * cosine8[0];
    const zd_real x23 = k[1] * cosine8[1];
    const zd_real x30 = x19 + x23;
    const zd_real x91 = p1 - x30;
    Phi[0] = x91;
    Phi[1] = -x15;
    if (!(fabs(Phi[0]) <= allowed[0]) || !(fabs(Phi[1]) <= allowed[1])) {
        const zd_real x115 = 1.0 / x23;
        const zd_real x374 = x15 * x115;
        dp[0] = ZD_SPLAT(0.0);
        dp[1] = ZD_FNMA(x14, x374, x91);
        dp[2] = x374;
        return ZD_NO_CONVERGENCE;
    }
    const zd_real x115 = 1.0 / x23;
    const zd_real x408 = x115 * ZD_FMA(x23, before2, x19 * before0);
    const zd_real v0 = before0;
    const zd_real v1 = before1 - ZD_FNMA(x14, x408, ZD_FMA(x14, before2, ZD_FMA(x10, before0, before1)));
    const zd_real v2 = before2 - x408;
    const zd_real x17 = -(0.5 * x15);
    const zd_real x32 = ZD_FNMA(0.5, x30, p1);
    const zd_real x42 = 0.5 * ZD_FMA(x32, ZD_FMA(x14, v2, ZD_FMA(x10, v0, v1 * 2.0)), x17 * (-ZD_FMA(x23, v2, x19 * v0)));
    const zd_real x46 = k[0] * ZD_FNMA(x17, cosine8[0], sine8[0] * x32);
    const zd_real x47 = 0.5 * x46;
    const zd_real x53 = ZD_FMA(x32, x32, x17 * x17);
    const zd_real x55 = ZD_SQRT(x53);
    const zd_real x57 = x55 - k[7];
    const zd_real x68 = x57 * k[11];
    const zd_real x75 = (k[8] - ((ZD_FMS(p1, 2.0, x30) * x68) / x55)) - ((x42 * (x32 * k[6])) / x53);
    const zd_real x79 = k[1] * ZD_FNMA(x17, cosine8[1], sine8[1] * x32);
    const zd_real x80 = 0.5 * x79;
    const zd_real x89 = ((x42 * (k[6] * x80)) / x53) + ZD_FMA(sine8[1], k[12], (x68 * x79) / x55);
    const zd_real x95 = v0 * v0;
    const zd_real x97 = v2 * v2;
    const zd_real x126 = x19 * x115;
    const zd_real x129 = k[4] * x126;
    const zd_real x365 = ZD_FNMA(x14, x126, x10);
    const zd_real x367 = k[3] * x365;
    const zd_real x412 = x115 * (added1 - ZD_FMA(x14, x97, x10 * x95));
    const zd_real x416 = ZD_FMA(x14, x412, added0 - ZD_FMA(x23, x97, x19 * x95));
    const zd_real x430 = ZD_FMS(x89, x126, ZD_FMA(x75, x365, ((x42 * (x47 * k[6])) / x53) + ((x57 * (x46 * k[11])) / x55))) - ZD_FNMA(x367, x416, x129 * x412);
    const zd_real x431 = (1.0 / ZD_FMA(x126, x129, ZD_FMA(x365, x367, k[2]))) * x430;
    const zd_real x434 = ZD_FNMA(x365, x431, x416);
    const zd_real x437 = ZD_FMA(x126, x431, x412);
    v[0] = v0;
    v[1] = v1;
    v[2] = v2;
    vdot[0] = x431;
    vdot[1] = x434;
    vdot[2] = -x437;
    if (lambda || power) {
        const zd_real x443 = ZD_FNMA(k[3], x434, x75);
        if (lambda) lambda[0] = x443;
        if (lambda) lambda[1] = -(x115 * ZD_FNMA(x14, x443, ZD_FMS(k[4], x437, x89)));
        if (power) power[0] = -(x42 * ((k[6] * ZD_FMA(v2, x80, ZD_FMA(x32, v1, v0 * x47))) / x53));
    }
    if (pivots || D) {
        if (pivots) pivots[0] = ZD_SPLAT(1.0);
        if (pivots) pivots[1] = -x23;
        if (pivots) pivots[2] = ZD_SPLAT(1.0);
        if (D) D[0] = -x365;
        if (D) D[1] = -x126;
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
    {1, solve_0, row_0, column_0, ZD_NAMED(accelerate_0), ZD_NAMED(correct_0), ZD_FINISH(finish_0), NULL},
};
#undef ZD_FINISH
#if ZD_LANES == 1
static const zd_elimination ZD_NAMED(embeddings)[] = {
    {2, solve_1, row_1, column_1, NULL, ZD_NAMED(correct_1), NULL, ZD_NAMED(embed_1)},
};
#endif

#undef ZD_UNIT
#undef ZD_LANES
#endif
