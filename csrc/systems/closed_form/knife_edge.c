/* Written by python/write_closed_form.py with SymPy 1.14.0, from tests/support/symbolic_counterparts.py. */
#ifndef ZD_LANES
#include "knife_edge.h"

#include <math.h>
#include "../../include/zerodrift/units.h"

/* Constants computed from the parameters alone, stored after them. */
void zd_knife_edge_closed_form_constants(double *k)
{
    (void)k;
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
#include "knife_edge.c"
#endif
#if (ZD_SETS) & ZD_SET_BASELINE_2
#define ZD_UNIT 0
#define ZD_LANES 2
#include "knife_edge.c"
#endif
#if (ZD_SETS) & ZD_SET_AVX2_1
#define ZD_UNIT 1
#define ZD_LANES 1
#include "knife_edge.c"
#endif
#if (ZD_SETS) & ZD_SET_AVX2_4
#define ZD_UNIT 1
#define ZD_LANES 4
#include "knife_edge.c"
#endif
#if (ZD_SETS) & ZD_SET_AVX512_1
#define ZD_UNIT 2
#define ZD_LANES 1
#include "knife_edge.c"
#endif
#if (ZD_SETS) & ZD_SET_AVX512_8
#define ZD_UNIT 2
#define ZD_LANES 8
#include "knife_edge.c"
#endif

const zd_closed_form zd_knife_edge_closed_form[] = {
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

ZD_ON_UNIT static int ZD_NAMED(accelerate_0)(const zd_elimination *self, const void *data, const double *at_inputs, const double *at_time, const double *at_p,
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
    (void)self, (void)t, (void)k, (void)input, (void)time, (void)p, (void)v, (void)added, (void)pdot, (void)vdot, (void)lambda, (void)power, (void)pivots;
    const zd_real p2 = p[2];
    const zd_real v0 = v[0], v1 = v[1], v2 = v[2];
    const zd_real added0 = added ? (zd_real)added[0] : ZD_SPLAT(0.0);
    /* vdot (17) */
    const zd_real angle7[ZD_PADDED(1)] = {p2};
    zd_real sine7[ZD_PADDED(1)], cosine7[ZD_PADDED(1)];
    ZD_SINES(1, angle7, sine7, cosine7);
    const zd_real x30 = k[0] * sine7[0];
    const zd_real x38 = ZD_FMA(sine7[0], x30, cosine7[0] * (k[0] * cosine7[0]));
    const zd_real x43 = 1.0 / (cosine7[0] * x38);
    const zd_real x45 = x38 * x43;
    const zd_real x64 = ZD_FNMA(ZD_FMA(sine7[0], v1, cosine7[0] * v0), v2, added0);
    const zd_real x72 = (cosine7[0] * x43) * ZD_FMA(cosine7[0], k[2] * cosine7[0], x30 * x64);
    const zd_real x81 = ZD_FNMA(x45, x64, x72 * (sine7[0] * x45));
    vdot[0] = x72;
    vdot[1] = x81;
    vdot[2] = ZD_SPLAT(0.0);
    /* lambda (8); power (28) */
    if (lambda || power) {
        if (lambda) lambda[0] = x45 * (k[0] * x81);
        if (power) power[0] = ZD_SPLAT(0.0);
    }
    if (pivots) {
        pivots[0] = -cosine7[0];
        pivots[1] = ZD_SPLAT(1.0);
        pivots[2] = ZD_SPLAT(1.0);
    }
    return ZD_DONE;
}

ZD_ON_UNIT static int ZD_NAMED(correct_0)(const zd_elimination *self, const void *data, const double *at_inputs, const double *at_time, const double *at_p,
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
    (void)self, (void)t, (void)k, (void)input, (void)time, (void)p, (void)v, (void)Phi, (void)dp, (void)dv;
    const zd_real p2 = p[2];
    const zd_real v0 = v[0], v1 = v[1];
    /* dp (25a), (26a), (27a); dv (25b), (26b), (27b) */
    const zd_real angle7[ZD_PADDED(1)] = {p2};
    zd_real sine7[ZD_PADDED(1)], cosine7[ZD_PADDED(1)];
    ZD_SINES(1, angle7, sine7, cosine7);
    const zd_real x30 = k[0] * sine7[0];
    const zd_real x38 = ZD_FMA(sine7[0], x30, cosine7[0] * (k[0] * cosine7[0]));
    const zd_real x43 = 1.0 / (cosine7[0] * x38);
    const zd_real x45 = x38 * x43;
    const zd_real x91 = ZD_FNMA(cosine7[0], v1, sine7[0] * v0);
    const zd_real x94 = (cosine7[0] * x43) * (x30 * x91);
    dp[0] = ZD_SPLAT(0.0);
    dp[1] = ZD_SPLAT(0.0);
    dp[2] = ZD_SPLAT(0.0);
    dv[0] = x94;
    dv[1] = ZD_FNMA(x45, x91, (sine7[0] * x45) * x94);
    dv[2] = ZD_SPLAT(0.0);
    return ZD_DONE;
}

#if ZD_LANES == 1
ZD_ON_UNIT static int ZD_NAMED(finish_0)(const zd_elimination *self, const void *data, const double *at_inputs, const double *at_time, const double *at_p,
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
    (void)self, (void)t, (void)k, (void)input, (void)time, (void)p, (void)allowed, (void)v, (void)Phi, (void)dp, (void)pdot, (void)vdot, (void)lambda, (void)power, (void)pivots;
    const zd_real p2 = p[2];
    const zd_real before0 = v[0], before1 = v[1], before2 = v[2];
    /* dv (25b), (26b), (27b) */
    const zd_real angle7[ZD_PADDED(1)] = {p2};
    zd_real sine7[ZD_PADDED(1)], cosine7[ZD_PADDED(1)];
    ZD_SINES(1, angle7, sine7, cosine7);
    const zd_real x30 = k[0] * sine7[0];
    const zd_real x38 = ZD_FMA(sine7[0], x30, cosine7[0] * (k[0] * cosine7[0]));
    const zd_real x43 = 1.0 / (cosine7[0] * x38);
    const zd_real x45 = x38 * x43;
    const zd_real x47 = cosine7[0] * x43;
    const zd_real x78 = sine7[0] * x45;
    const zd_real x106 = ZD_FNMA(cosine7[0], before1, sine7[0] * before0);
    const zd_real x109 = x47 * (x30 * x106);
    const zd_real v0 = before0 - x109;
    const zd_real v1 = before1 - ZD_FNMA(x45, x106, x78 * x109);
    const zd_real v2 = before2;
    /* vdot (17) */
    const zd_real x16 = ZD_FMA(sine7[0], v1, cosine7[0] * v0) * v2;
    const zd_real x118 = x47 * ZD_FNMA(x16, x30, cosine7[0] * (k[2] * cosine7[0]));
    const zd_real x123 = ZD_FMA(x78, x118, x16 * x45);
    v[0] = v0;
    v[1] = v1;
    v[2] = v2;
    vdot[0] = x118;
    vdot[1] = x123;
    vdot[2] = ZD_SPLAT(0.0);
    /* lambda (8); power (28) */
    if (lambda || power) {
        if (lambda) lambda[0] = x45 * (k[0] * x123);
        if (power) power[0] = ZD_SPLAT(0.0);
    }
    if (pivots) {
        pivots[0] = -cosine7[0];
        pivots[1] = ZD_SPLAT(1.0);
        pivots[2] = ZD_SPLAT(1.0);
    }
    return ZD_DONE;
}
#endif

ZD_ON_UNIT static int ZD_NAMED(accelerate_1)(const zd_elimination *self, const void *data, const double *at_inputs, const double *at_time, const double *at_p,
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
    (void)self, (void)t, (void)k, (void)input, (void)time, (void)p, (void)v, (void)added, (void)pdot, (void)vdot, (void)lambda, (void)power, (void)pivots;
    const zd_real p2 = p[2];
    const zd_real v0 = v[0], v1 = v[1], v2 = v[2];
    const zd_real added0 = added ? (zd_real)added[0] : ZD_SPLAT(0.0);
    /* vdot (17) */
    const zd_real angle7[ZD_PADDED(1)] = {p2};
    zd_real sine7[ZD_PADDED(1)], cosine7[ZD_PADDED(1)];
    ZD_SINES(1, angle7, sine7, cosine7);
    const zd_real x28 = k[0] * cosine7[0];
    const zd_real x38 = ZD_FMA(sine7[0], k[0] * sine7[0], cosine7[0] * x28);
    const zd_real x59 = 1.0 / (sine7[0] * x38);
    const zd_real x60 = x38 * x59;
    const zd_real x64 = ZD_FNMA(ZD_FMA(sine7[0], v1, cosine7[0] * v0), v2, added0);
    const zd_real x134 = (sine7[0] * x59) * ZD_FNMA(x28, x64, sine7[0] * (k[2] * cosine7[0]));
    const zd_real x138 = ZD_FMA(x134, cosine7[0] * x60, x60 * x64);
    vdot[0] = x138;
    vdot[1] = x134;
    vdot[2] = ZD_SPLAT(0.0);
    /* lambda (8); power (28) */
    if (lambda || power) {
        if (lambda) lambda[0] = x60 * ZD_FNMA(k[0], x138, k[2]);
        if (power) power[0] = ZD_SPLAT(0.0);
    }
    if (pivots) {
        pivots[0] = sine7[0];
        pivots[1] = ZD_SPLAT(1.0);
        pivots[2] = ZD_SPLAT(1.0);
    }
    return ZD_DONE;
}

ZD_ON_UNIT static int ZD_NAMED(correct_1)(const zd_elimination *self, const void *data, const double *at_inputs, const double *at_time, const double *at_p,
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
    (void)self, (void)t, (void)k, (void)input, (void)time, (void)p, (void)v, (void)Phi, (void)dp, (void)dv;
    const zd_real p2 = p[2];
    const zd_real v0 = v[0], v1 = v[1];
    /* dp (25a), (26a), (27a); dv (25b), (26b), (27b) */
    const zd_real angle7[ZD_PADDED(1)] = {p2};
    zd_real sine7[ZD_PADDED(1)], cosine7[ZD_PADDED(1)];
    ZD_SINES(1, angle7, sine7, cosine7);
    const zd_real x28 = k[0] * cosine7[0];
    const zd_real x38 = ZD_FMA(sine7[0], k[0] * sine7[0], cosine7[0] * x28);
    const zd_real x59 = 1.0 / (sine7[0] * x38);
    const zd_real x60 = x38 * x59;
    const zd_real x91 = ZD_FNMA(cosine7[0], v1, sine7[0] * v0);
    const zd_real x148 = (sine7[0] * x59) * (x28 * x91);
    dp[0] = ZD_SPLAT(0.0);
    dp[1] = ZD_SPLAT(0.0);
    dp[2] = ZD_SPLAT(0.0);
    dv[0] = ZD_FNMA(cosine7[0] * x60, x148, x60 * x91);
    dv[1] = -x148;
    dv[2] = ZD_SPLAT(0.0);
    return ZD_DONE;
}

#if ZD_LANES == 1
ZD_ON_UNIT static int ZD_NAMED(finish_1)(const zd_elimination *self, const void *data, const double *at_inputs, const double *at_time, const double *at_p,
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
    (void)self, (void)t, (void)k, (void)input, (void)time, (void)p, (void)allowed, (void)v, (void)Phi, (void)dp, (void)pdot, (void)vdot, (void)lambda, (void)power, (void)pivots;
    const zd_real p2 = p[2];
    const zd_real before0 = v[0], before1 = v[1], before2 = v[2];
    /* dv (25b), (26b), (27b) */
    const zd_real angle7[ZD_PADDED(1)] = {p2};
    zd_real sine7[ZD_PADDED(1)], cosine7[ZD_PADDED(1)];
    ZD_SINES(1, angle7, sine7, cosine7);
    const zd_real x28 = k[0] * cosine7[0];
    const zd_real x38 = ZD_FMA(sine7[0], k[0] * sine7[0], cosine7[0] * x28);
    const zd_real x59 = 1.0 / (sine7[0] * x38);
    const zd_real x60 = x38 * x59;
    const zd_real x61 = sine7[0] * x59;
    const zd_real x106 = ZD_FNMA(cosine7[0], before1, sine7[0] * before0);
    const zd_real x136 = cosine7[0] * x60;
    const zd_real x158 = x61 * (x28 * x106);
    const zd_real v0 = before0 - ZD_FNMA(x136, x158, x60 * x106);
    const zd_real v1 = before1 - (-x158);
    const zd_real v2 = before2;
    /* vdot (17) */
    const zd_real x16 = ZD_FMA(sine7[0], v1, cosine7[0] * v0) * v2;
    const zd_real x169 = x61 * ZD_FMA(x16, x28, sine7[0] * (k[2] * cosine7[0]));
    const zd_real x173 = ZD_FNMA(x16, x60, x136 * x169);
    v[0] = v0;
    v[1] = v1;
    v[2] = v2;
    vdot[0] = x173;
    vdot[1] = x169;
    vdot[2] = ZD_SPLAT(0.0);
    /* lambda (8); power (28) */
    if (lambda || power) {
        if (lambda) lambda[0] = x60 * ZD_FNMA(k[0], x173, k[2]);
        if (power) power[0] = ZD_SPLAT(0.0);
    }
    if (pivots) {
        pivots[0] = sine7[0];
        pivots[1] = ZD_SPLAT(1.0);
        pivots[2] = ZD_SPLAT(1.0);
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
    {1, solve_1, row_1, column_1, ZD_NAMED(accelerate_1), ZD_NAMED(correct_1), ZD_FINISH(finish_1), NULL, NULL},
};
#undef ZD_FINISH

#undef ZD_UNIT
#undef ZD_LANES
#endif
