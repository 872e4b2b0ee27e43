/* Written by python/write_closed_form.py with SymPy 1.14.0, from tests/symbolic_counterparts.py. */
#ifndef ZD_LANES
#include "chaplygin_sleigh.h"

#include <math.h>
#include "../../include/zerodrift/units.h"

/* Constants computed from the parameters alone, stored after them. */
void zd_chaplygin_sleigh_closed_form_constants(double *k)
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

const zd_closed_form zd_chaplygin_sleigh_closed_form[] = {
#if (ZD_SETS) & ZD_SET_BASELINE_1
    {0, 1, 2, orders_0_1, 0, NULL},
#endif
#if (ZD_SETS) & ZD_SET_BASELINE_2
    {0, 2, 2, orders_0_2, 0, NULL},
#endif
#if (ZD_SETS) & ZD_SET_AVX2_1
    {1, 1, 2, orders_1_1, 0, NULL},
#endif
#if (ZD_SETS) & ZD_SET_AVX2_4
    {1, 4, 2, orders_1_4, 0, NULL},
#endif
#if (ZD_SETS) & ZD_SET_AVX512_1
    {2, 1, 2, orders_2_1, 0, NULL},
#endif
#if (ZD_SETS) & ZD_SET_AVX512_8
    {2, 8, 2, orders_2_8, 0, NULL},
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
    const zd_real p2 = p[2];
    const zd_real v0 = v[0], v1 = v[1], v2 = v[2];
    const zd_real added0 = added ? (zd_real)added[0] : ZD_SPLAT(0.0);
    const zd_real x17 = v2 * v2;
    const zd_real angle5[ZD_PADDED(1)] = {p2};
    zd_real sine5[ZD_PADDED(1)], cosine5[ZD_PADDED(1)];
    ZD_SINES(1, angle5, sine5, cosine5);
    const zd_real x8 = sine5[0] * k[6];
    const zd_real x11 = k[6] * cosine5[0];
    const zd_real x20 = x8 * x17;
    const zd_real x50 = k[0] * sine5[0];
    const zd_real x57 = ZD_FMA(sine5[0], x50, cosine5[0] * (k[0] * cosine5[0]));
    const zd_real x62 = cosine5[0] * ZD_FNMA(x8, cosine5[0], sine5[0] * x11);
    const zd_real x63 = cosine5[0] * (cosine5[0] * k[7]);
    const zd_real x65 = x57 * x63;
    const zd_real x68 = ZD_FNMA(x62, x62, x65);
    const zd_real x70 = 1.0 / (cosine5[0] * x68);
    const zd_real x71 = x68 * x70;
    const zd_real x72 = cosine5[0] * x70;
    const zd_real x74 = x62 * x72;
    const zd_real x136 = ZD_FMA(v2, ZD_FMA(cosine5[0], v0, sine5[0] * v1), added0);
    const zd_real x139 = (cosine5[0] * x11) * x136;
    const zd_real x145 = ZD_FNMA(x50, x136, cosine5[0] * ZD_FMA(sine5[0], x20, cosine5[0] * (x11 * x17)));
    const zd_real x149 = ZD_FMA(x74, x139, (x63 * x72) * x145);
    const zd_real x154 = ZD_FMA(x57 * x72, x139, x74 * x145);
    const zd_real x161 = ZD_FMA(x149, sine5[0] * x71, x71 * x136);
    vdot[0] = x149;
    vdot[1] = x161;
    vdot[2] = -x154;
    if (lambda || power) {
        if (lambda) lambda[0] = x71 * (x20 - ZD_FNMA(x11, x154, k[0] * x161));
        if (power) power[0] = ZD_SPLAT(0.0);
    }
    if (pivots) {
        pivots[0] = cosine5[0];
        pivots[1] = ZD_SPLAT(1.0);
        pivots[2] = x68 / x65;
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
    const zd_real p2 = p[2];
    const zd_real v0 = v[0], v1 = v[1];
    const zd_real angle5[ZD_PADDED(1)] = {p2};
    zd_real sine5[ZD_PADDED(1)], cosine5[ZD_PADDED(1)];
    ZD_SINES(1, angle5, sine5, cosine5);
    const zd_real x11 = k[6] * cosine5[0];
    const zd_real x50 = k[0] * sine5[0];
    const zd_real x57 = ZD_FMA(sine5[0], x50, cosine5[0] * (k[0] * cosine5[0]));
    const zd_real x62 = cosine5[0] * ZD_FNMA(sine5[0] * k[6], cosine5[0], sine5[0] * x11);
    const zd_real x63 = cosine5[0] * (cosine5[0] * k[7]);
    const zd_real x68 = ZD_FNMA(x62, x62, x57 * x63);
    const zd_real x70 = 1.0 / (cosine5[0] * x68);
    const zd_real x71 = x68 * x70;
    const zd_real x72 = cosine5[0] * x70;
    const zd_real x74 = x62 * x72;
    const zd_real x186 = ZD_FNMA(sine5[0], v0, cosine5[0] * v1);
    const zd_real x187 = x50 * x186;
    const zd_real x189 = (cosine5[0] * x11) * x186;
    const zd_real x195 = ZD_FNMA(x63 * x72, x187, x74 * x189);
    dp[0] = ZD_SPLAT(0.0);
    dp[1] = ZD_SPLAT(0.0);
    dp[2] = ZD_SPLAT(0.0);
    dv[0] = x195;
    dv[1] = ZD_FMA(sine5[0] * x71, x195, x71 * x186);
    dv[2] = ZD_FNMA(x57 * x72, x189, x74 * x187);
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
    const zd_real p2 = p[2];
    const zd_real before0 = v[0], before1 = v[1], before2 = v[2];
    const zd_real angle5[ZD_PADDED(1)] = {p2};
    zd_real sine5[ZD_PADDED(1)], cosine5[ZD_PADDED(1)];
    ZD_SINES(1, angle5, sine5, cosine5);
    const zd_real x8 = sine5[0] * k[6];
    const zd_real x11 = k[6] * cosine5[0];
    const zd_real x50 = k[0] * sine5[0];
    const zd_real x51 = cosine5[0] * x11;
    const zd_real x57 = ZD_FMA(sine5[0], x50, cosine5[0] * (k[0] * cosine5[0]));
    const zd_real x62 = cosine5[0] * ZD_FNMA(x8, cosine5[0], sine5[0] * x11);
    const zd_real x63 = cosine5[0] * (cosine5[0] * k[7]);
    const zd_real x65 = x57 * x63;
    const zd_real x68 = ZD_FNMA(x62, x62, x65);
    const zd_real x70 = 1.0 / (cosine5[0] * x68);
    const zd_real x71 = x68 * x70;
    const zd_real x72 = cosine5[0] * x70;
    const zd_real x73 = x63 * x72;
    const zd_real x74 = x62 * x72;
    const zd_real x76 = x57 * x72;
    const zd_real x159 = sine5[0] * x71;
    const zd_real x212 = ZD_FNMA(sine5[0], before0, cosine5[0] * before1);
    const zd_real x213 = x50 * x212;
    const zd_real x215 = x51 * x212;
    const zd_real x221 = ZD_FNMA(x73, x213, x74 * x215);
    const zd_real v0 = before0 - x221;
    const zd_real v1 = before1 - ZD_FMA(x159, x221, x71 * x212);
    const zd_real v2 = before2 - ZD_FNMA(x76, x215, x74 * x213);
    const zd_real x17 = v2 * v2;
    const zd_real x20 = x8 * x17;
    const zd_real x28 = v2 * ZD_FMA(cosine5[0], v0, sine5[0] * v1);
    const zd_real x234 = x28 * x51;
    const zd_real x236 = ZD_FNMA(x28, x50, cosine5[0] * ZD_FMA(sine5[0], x20, cosine5[0] * (x11 * x17)));
    const zd_real x240 = ZD_FMA(x74, x234, x73 * x236);
    const zd_real x245 = ZD_FMA(x76, x234, x74 * x236);
    const zd_real x250 = ZD_FMA(x159, x240, x28 * x71);
    v[0] = v0;
    v[1] = v1;
    v[2] = v2;
    vdot[0] = x240;
    vdot[1] = x250;
    vdot[2] = -x245;
    if (lambda || power) {
        if (lambda) lambda[0] = x71 * (x20 - ZD_FNMA(x11, x245, k[0] * x250));
        if (power) power[0] = ZD_SPLAT(0.0);
    }
    if (pivots) {
        pivots[0] = cosine5[0];
        pivots[1] = ZD_SPLAT(1.0);
        pivots[2] = x68 / x65;
    }
    return ZD_DONE;
}
#endif

ZD_ON_UNIT static int ZD_NAMED(accelerate_1)(const void *data, const double *at_inputs, const double *at_time, const double *at_p,
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
    const zd_real p2 = p[2];
    const zd_real v0 = v[0], v1 = v[1], v2 = v[2];
    const zd_real added0 = added ? (zd_real)added[0] : ZD_SPLAT(0.0);
    const zd_real x17 = v2 * v2;
    const zd_real angle5[ZD_PADDED(1)] = {p2};
    zd_real sine5[ZD_PADDED(1)], cosine5[ZD_PADDED(1)];
    ZD_SINES(1, angle5, sine5, cosine5);
    const zd_real x8 = sine5[0] * k[6];
    const zd_real x11 = k[6] * cosine5[0];
    const zd_real x18 = x11 * x17;
    const zd_real x47 = k[0] * cosine5[0];
    const zd_real x57 = ZD_FMA(sine5[0], k[0] * sine5[0], cosine5[0] * x47);
    const zd_real x115 = sine5[0] * ZD_FNMA(sine5[0], x11, x8 * cosine5[0]);
    const zd_real x117 = sine5[0] * (sine5[0] * k[7]);
    const zd_real x119 = x57 * x117;
    const zd_real x122 = ZD_FNMA(x115, x115, x119);
    const zd_real x125 = 1.0 / (sine5[0] * x122);
    const zd_real x127 = x122 * x125;
    const zd_real x129 = sine5[0] * x125;
    const zd_real x132 = x115 * x129;
    const zd_real x136 = ZD_FMA(v2, ZD_FMA(cosine5[0], v0, sine5[0] * v1), added0);
    const zd_real x274 = (sine5[0] * x8) * x136;
    const zd_real x281 = ZD_FMA(sine5[0], ZD_FMA(sine5[0], x8 * x17, cosine5[0] * x18), x47 * x136);
    const zd_real x285 = ZD_FNMA(x132, x274, (x117 * x129) * x281);
    const zd_real x289 = ZD_FNMA(x57 * x129, x274, x132 * x281);
    const zd_real x295 = ZD_FNMA(x127, x136, x285 * (cosine5[0] * x127));
    vdot[0] = x295;
    vdot[1] = x285;
    vdot[2] = x289;
    if (lambda || power) {
        if (lambda) lambda[0] = -(x127 * (x18 - ZD_FNMA(x8, x289, k[0] * x295)));
        if (power) power[0] = ZD_SPLAT(0.0);
    }
    if (pivots) {
        pivots[0] = -sine5[0];
        pivots[1] = ZD_SPLAT(1.0);
        pivots[2] = x122 / x119;
    }
    return ZD_DONE;
}

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
    const zd_real p2 = p[2];
    const zd_real v0 = v[0], v1 = v[1];
    const zd_real angle5[ZD_PADDED(1)] = {p2};
    zd_real sine5[ZD_PADDED(1)], cosine5[ZD_PADDED(1)];
    ZD_SINES(1, angle5, sine5, cosine5);
    const zd_real x8 = sine5[0] * k[6];
    const zd_real x47 = k[0] * cosine5[0];
    const zd_real x57 = ZD_FMA(sine5[0], k[0] * sine5[0], cosine5[0] * x47);
    const zd_real x115 = sine5[0] * ZD_FNMA(sine5[0], k[6] * cosine5[0], x8 * cosine5[0]);
    const zd_real x117 = sine5[0] * (sine5[0] * k[7]);
    const zd_real x122 = ZD_FNMA(x115, x115, x57 * x117);
    const zd_real x125 = 1.0 / (sine5[0] * x122);
    const zd_real x127 = x122 * x125;
    const zd_real x129 = sine5[0] * x125;
    const zd_real x132 = x115 * x129;
    const zd_real x186 = ZD_FNMA(sine5[0], v0, cosine5[0] * v1);
    const zd_real x318 = x47 * x186;
    const zd_real x320 = (sine5[0] * x8) * x186;
    const zd_real x325 = ZD_FNMA(x132, x320, (x117 * x129) * x318);
    dp[0] = ZD_SPLAT(0.0);
    dp[1] = ZD_SPLAT(0.0);
    dp[2] = ZD_SPLAT(0.0);
    dv[0] = ZD_FNMA(x127, x186, (cosine5[0] * x127) * x325);
    dv[1] = x325;
    dv[2] = ZD_FNMA(x57 * x129, x320, x132 * x318);
    return ZD_DONE;
}

#if ZD_LANES == 1
ZD_ON_UNIT static int ZD_NAMED(finish_1)(const void *data, const double *at_inputs, const double *at_time, const double *at_p,
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
    const zd_real p2 = p[2];
    const zd_real before0 = v[0], before1 = v[1], before2 = v[2];
    const zd_real angle5[ZD_PADDED(1)] = {p2};
    zd_real sine5[ZD_PADDED(1)], cosine5[ZD_PADDED(1)];
    ZD_SINES(1, angle5, sine5, cosine5);
    const zd_real x8 = sine5[0] * k[6];
    const zd_real x11 = k[6] * cosine5[0];
    const zd_real x47 = k[0] * cosine5[0];
    const zd_real x57 = ZD_FMA(sine5[0], k[0] * sine5[0], cosine5[0] * x47);
    const zd_real x101 = sine5[0] * x8;
    const zd_real x115 = sine5[0] * ZD_FNMA(sine5[0], x11, x8 * cosine5[0]);
    const zd_real x117 = sine5[0] * (sine5[0] * k[7]);
    const zd_real x119 = x57 * x117;
    const zd_real x122 = ZD_FNMA(x115, x115, x119);
    const zd_real x125 = 1.0 / (sine5[0] * x122);
    const zd_real x127 = x122 * x125;
    const zd_real x129 = sine5[0] * x125;
    const zd_real x131 = x117 * x129;
    const zd_real x132 = x115 * x129;
    const zd_real x133 = x57 * x129;
    const zd_real x212 = ZD_FNMA(sine5[0], before0, cosine5[0] * before1);
    const zd_real x292 = cosine5[0] * x127;
    const zd_real x336 = x47 * x212;
    const zd_real x338 = x101 * x212;
    const zd_real x343 = ZD_FNMA(x132, x338, x131 * x336);
    const zd_real v0 = before0 - ZD_FNMA(x127, x212, x292 * x343);
    const zd_real v1 = before1 - x343;
    const zd_real v2 = before2 - ZD_FNMA(x133, x338, x132 * x336);
    const zd_real x17 = v2 * v2;
    const zd_real x18 = x11 * x17;
    const zd_real x28 = v2 * ZD_FMA(cosine5[0], v0, sine5[0] * v1);
    const zd_real x356 = x28 * x101;
    const zd_real x358 = ZD_FMA(x28, x47, sine5[0] * ZD_FMA(sine5[0], x8 * x17, cosine5[0] * x18));
    const zd_real x362 = ZD_FNMA(x132, x356, x131 * x358);
    const zd_real x366 = ZD_FNMA(x133, x356, x132 * x358);
    const zd_real x370 = ZD_FNMA(x28, x127, x292 * x362);
    v[0] = v0;
    v[1] = v1;
    v[2] = v2;
    vdot[0] = x370;
    vdot[1] = x362;
    vdot[2] = x366;
    if (lambda || power) {
        if (lambda) lambda[0] = -(x127 * (x18 - ZD_FNMA(x8, x366, k[0] * x370)));
        if (power) power[0] = ZD_SPLAT(0.0);
    }
    if (pivots) {
        pivots[0] = -sine5[0];
        pivots[1] = ZD_SPLAT(1.0);
        pivots[2] = x122 / x119;
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
    {1, solve_1, row_1, column_1, ZD_NAMED(accelerate_1), ZD_NAMED(correct_1), ZD_FINISH(finish_1), NULL},
};
#undef ZD_FINISH

#undef ZD_UNIT
#undef ZD_LANES
#endif
