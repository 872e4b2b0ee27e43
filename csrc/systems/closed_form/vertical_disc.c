/* Written by python/write_closed_form.py with SymPy 1.14.0, from tests/symbolic_counterparts.py. */
#ifndef ZD_LANES
#include "vertical_disc.h"

#include <math.h>
#include "../../include/zerodrift/units.h"

/* Constants computed from the parameters alone, stored after them. */
void zd_vertical_disc_closed_form_constants(double *k)
{
    (void)k;
}

static const int solve_0[] = {0, 0};
static const int row_0[] = {0, 1};
static const int column_0[] = {0, 1};
static const int solve_1[] = {0, 1};
static const int row_1[] = {0, 1};
static const int column_1[] = {0, 1};

/* The functions below, for each vector unit. */
#if (ZD_SETS) & ZD_SET_BASELINE_1
#define ZD_UNIT 0
#define ZD_LANES 1
#include "vertical_disc.c"
#endif
#if (ZD_SETS) & ZD_SET_BASELINE_2
#define ZD_UNIT 0
#define ZD_LANES 2
#include "vertical_disc.c"
#endif
#if (ZD_SETS) & ZD_SET_AVX2_1
#define ZD_UNIT 1
#define ZD_LANES 1
#include "vertical_disc.c"
#endif
#if (ZD_SETS) & ZD_SET_AVX2_4
#define ZD_UNIT 1
#define ZD_LANES 4
#include "vertical_disc.c"
#endif
#if (ZD_SETS) & ZD_SET_AVX512_1
#define ZD_UNIT 2
#define ZD_LANES 1
#include "vertical_disc.c"
#endif
#if (ZD_SETS) & ZD_SET_AVX512_8
#define ZD_UNIT 2
#define ZD_LANES 8
#include "vertical_disc.c"
#endif

const zd_closed_form zd_vertical_disc_closed_form[] = {
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
    const zd_real p2 = p[2];
    const zd_real v2 = v[2], v3 = v[3];
    const zd_real added0 = added ? (zd_real)added[0] : ZD_SPLAT(0.0), added1 = added ? (zd_real)added[1] : ZD_SPLAT(0.0);
    const zd_real angle7[ZD_PADDED(1)] = {p2};
    zd_real sine7[ZD_PADDED(1)], cosine7[ZD_PADDED(1)];
    ZD_SINES(1, angle7, sine7, cosine7);
    const zd_real x9 = cosine7[0] * k[1];
    const zd_real x12 = k[1] * sine7[0];
    const zd_real x21 = k[0] * x9;
    const zd_real x22 = k[0] * x12;
    const zd_real x31 = ZD_FNMA(v3, x12 * v2, added0);
    const zd_real x32 = ZD_FMA(v3, x9 * v2, added1);
    const zd_real x39 = (1.0 / (k[2] + ZD_FMA(x12, x22, x9 * x21))) * ZD_FMA(x22, x32, x21 * x31);
    const zd_real x43 = ZD_FNMA(x9, x39, x31);
    const zd_real x46 = ZD_FNMA(x12, x39, x32);
    vdot[0] = x43;
    vdot[1] = x46;
    vdot[2] = ZD_SPLAT(0.0);
    vdot[3] = -x39;
    if (lambda || power) {
        if (lambda) lambda[0] = -(k[0] * x43);
        if (lambda) lambda[1] = -(k[0] * x46);
        if (power) power[0] = ZD_SPLAT(0.0);
    }
    if (pivots) {
        pivots[0] = ZD_SPLAT(1.0);
        pivots[1] = ZD_SPLAT(1.0);
        pivots[2] = ZD_SPLAT(1.0);
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
    const zd_real v0 = v[0], v1 = v[1], v3 = v[3];
    const zd_real angle7[ZD_PADDED(1)] = {p2};
    zd_real sine7[ZD_PADDED(1)], cosine7[ZD_PADDED(1)];
    ZD_SINES(1, angle7, sine7, cosine7);
    const zd_real x9 = cosine7[0] * k[1];
    const zd_real x12 = k[1] * sine7[0];
    const zd_real x21 = k[0] * x9;
    const zd_real x22 = k[0] * x12;
    const zd_real x55 = ZD_FNMA(x9, v3, v0);
    const zd_real x58 = ZD_FNMA(x12, v3, v1);
    const zd_real x63 = (1.0 / (k[2] + ZD_FMA(x12, x22, x9 * x21))) * ZD_FMA(x22, x58, x21 * x55);
    dp[0] = ZD_SPLAT(0.0);
    dp[1] = ZD_SPLAT(0.0);
    dp[2] = ZD_SPLAT(0.0);
    dp[3] = ZD_SPLAT(0.0);
    dv[0] = ZD_FNMA(x9, x63, x55);
    dv[1] = ZD_FNMA(x12, x63, x58);
    dv[2] = ZD_SPLAT(0.0);
    dv[3] = -x63;
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
    const zd_real before0 = v[0], before1 = v[1], before2 = v[2], before3 = v[3];
    const zd_real angle7[ZD_PADDED(1)] = {p2};
    zd_real sine7[ZD_PADDED(1)], cosine7[ZD_PADDED(1)];
    ZD_SINES(1, angle7, sine7, cosine7);
    const zd_real x9 = cosine7[0] * k[1];
    const zd_real x12 = k[1] * sine7[0];
    const zd_real x21 = k[0] * x9;
    const zd_real x22 = k[0] * x12;
    const zd_real x28 = 1.0 / (k[2] + ZD_FMA(x12, x22, x9 * x21));
    const zd_real x77 = ZD_FNMA(x9, before3, before0);
    const zd_real x80 = ZD_FNMA(x12, before3, before1);
    const zd_real x85 = x28 * ZD_FMA(x22, x80, x21 * x77);
    const zd_real v0 = before0 - ZD_FNMA(x9, x85, x77);
    const zd_real v1 = before1 - ZD_FNMA(x12, x85, x80);
    const zd_real v2 = before2;
    const zd_real v3 = before3 - (-x85);
    const zd_real x17 = v3 * (x12 * v2);
    const zd_real x20 = v3 * (x9 * v2);
    const zd_real x98 = x28 * ZD_FNMA(x17, x21, x20 * x22);
    const zd_real x102 = ZD_FMA(x9, x98, x17);
    const zd_real x106 = ZD_FNMA(x12, x98, x20);
    v[0] = v0;
    v[1] = v1;
    v[2] = v2;
    v[3] = v3;
    vdot[0] = -x102;
    vdot[1] = x106;
    vdot[2] = ZD_SPLAT(0.0);
    vdot[3] = -x98;
    if (lambda || power) {
        if (lambda) lambda[0] = k[0] * x102;
        if (lambda) lambda[1] = -(k[0] * x106);
        if (power) power[0] = ZD_SPLAT(0.0);
    }
    if (pivots) {
        pivots[0] = ZD_SPLAT(1.0);
        pivots[1] = ZD_SPLAT(1.0);
        pivots[2] = ZD_SPLAT(1.0);
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
    const zd_real p2 = p[2];
    const zd_real v0 = v[0], v1 = v[1], v3 = v[3];
    const zd_real angle7[ZD_PADDED(1)] = {p2};
    zd_real sine7[ZD_PADDED(1)], cosine7[ZD_PADDED(1)];
    ZD_SINES(1, angle7, sine7, cosine7);
    const zd_real x9 = cosine7[0] * k[1];
    const zd_real x12 = k[1] * sine7[0];
    const zd_real x21 = k[0] * x9;
    const zd_real x22 = k[0] * x12;
    const zd_real x55 = ZD_FNMA(x9, v3, v0);
    const zd_real x58 = ZD_FNMA(x12, v3, v1);
    const zd_real x63 = (1.0 / (k[2] + ZD_FMA(x12, x22, x9 * x21))) * ZD_FMA(x22, x58, x21 * x55);
    dp[0] = ZD_SPLAT(0.0);
    dp[1] = ZD_SPLAT(0.0);
    dp[2] = ZD_SPLAT(0.0);
    dp[3] = ZD_SPLAT(0.0);
    dv[0] = ZD_FNMA(x9, x63, x55);
    dv[1] = ZD_FNMA(x12, x63, x58);
    dv[2] = ZD_SPLAT(0.0);
    dv[3] = -x63;
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
    const zd_real p2 = p[2];
    const zd_real before0 = v[0], before1 = v[1], before2 = v[2], before3 = v[3];
    const zd_real added0 = added ? (zd_real)added[0] : ZD_SPLAT(0.0), added1 = added ? (zd_real)added[1] : ZD_SPLAT(0.0);
    const zd_real angle7[ZD_PADDED(1)] = {p2};
    zd_real sine7[ZD_PADDED(1)], cosine7[ZD_PADDED(1)];
    ZD_SINES(1, angle7, sine7, cosine7);
    const zd_real x9 = cosine7[0] * k[1];
    const zd_real x12 = k[1] * sine7[0];
    const zd_real v0 = before0 - ZD_FNMA(x9, before3, before0);
    const zd_real v1 = before1 - ZD_FNMA(x12, before3, before1);
    const zd_real v2 = before2;
    const zd_real v3 = before3;
    const zd_real x21 = k[0] * x9;
    const zd_real x22 = k[0] * x12;
    const zd_real x31 = ZD_FNMA(v3, x12 * v2, added0);
    const zd_real x32 = ZD_FMA(v3, x9 * v2, added1);
    const zd_real x39 = (1.0 / (k[2] + ZD_FMA(x12, x22, x9 * x21))) * ZD_FMA(x22, x32, x21 * x31);
    const zd_real x43 = ZD_FNMA(x9, x39, x31);
    const zd_real x46 = ZD_FNMA(x12, x39, x32);
    v[0] = v0;
    v[1] = v1;
    v[2] = v2;
    v[3] = v3;
    vdot[0] = x43;
    vdot[1] = x46;
    vdot[2] = ZD_SPLAT(0.0);
    vdot[3] = -x39;
    if (lambda || power) {
        if (lambda) lambda[0] = -(k[0] * x43);
        if (lambda) lambda[1] = -(k[0] * x46);
        if (power) power[0] = ZD_SPLAT(0.0);
    }
    if (pivots || D) {
        if (pivots) pivots[0] = ZD_SPLAT(1.0);
        if (pivots) pivots[1] = ZD_SPLAT(1.0);
        if (pivots) pivots[2] = ZD_SPLAT(1.0);
        if (pivots) pivots[3] = ZD_SPLAT(1.0);
        if (D) D[0] = ZD_SPLAT(0.0);
        if (D) D[1] = x9;
        if (D) D[2] = ZD_SPLAT(0.0);
        if (D) D[3] = x12;
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
