/* Written by python/write_closed_form.py with SymPy 1.14.0, from tests/support/symbolic_counterparts.py. */
#ifndef ZD_LANES
#include "pendulum.h"

#include <math.h>
#include "../../include/zerodrift/units.h"

/* Constants computed from the parameters alone, stored after them. */
void zd_pendulum_closed_form_constants(double *k)
{
    k[5] = k[1] * k[2];
    k[8] = k[0] * k[0];
    k[6] = 1.0 / k[0];
    k[7] = k[6] * 0.5;
}

static const int solve_0[] = {0};
static const int row_0[] = {0};
static const int column_0[] = {0};
static const int solve_1[] = {0};
static const int row_1[] = {0};
static const int column_1[] = {1};
static const int solve_2[] = {0};
static const int row_2[] = {0};
static const int column_2[] = {0};
static const int solve_3[] = {0};
static const int row_3[] = {0};
static const int column_3[] = {1};

/* The functions below, for each vector unit. */
#if (ZD_SETS) & ZD_SET_BASELINE_1
#define ZD_UNIT 0
#define ZD_LANES 1
#include "pendulum.c"
#endif
#if (ZD_SETS) & ZD_SET_BASELINE_2
#define ZD_UNIT 0
#define ZD_LANES 2
#include "pendulum.c"
#endif
#if (ZD_SETS) & ZD_SET_AVX2_1
#define ZD_UNIT 1
#define ZD_LANES 1
#include "pendulum.c"
#endif
#if (ZD_SETS) & ZD_SET_AVX2_4
#define ZD_UNIT 1
#define ZD_LANES 4
#include "pendulum.c"
#endif
#if (ZD_SETS) & ZD_SET_AVX512_1
#define ZD_UNIT 2
#define ZD_LANES 1
#include "pendulum.c"
#endif
#if (ZD_SETS) & ZD_SET_AVX512_8
#define ZD_UNIT 2
#define ZD_LANES 8
#include "pendulum.c"
#endif

const zd_closed_form zd_pendulum_closed_form[] = {
#if (ZD_SETS) & ZD_SET_BASELINE_1
    {0, 1, 2, orders_0_1, 2, embeddings_0_1},
#endif
#if (ZD_SETS) & ZD_SET_BASELINE_2
    {0, 2, 2, orders_0_2, 0, NULL},
#endif
#if (ZD_SETS) & ZD_SET_AVX2_1
    {1, 1, 2, orders_1_1, 2, embeddings_1_1},
#endif
#if (ZD_SETS) & ZD_SET_AVX2_4
    {1, 4, 2, orders_1_4, 0, NULL},
#endif
#if (ZD_SETS) & ZD_SET_AVX512_1
    {2, 1, 2, orders_2_1, 2, embeddings_2_1},
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
    const zd_real p0 = p[0], p1 = p[1];
    const zd_real v0 = v[0], v1 = v[1];
    const zd_real added0 = added ? (zd_real)added[0] : ZD_SPLAT(0.0);
    /* vdot (17) */
    const zd_real x19 = p0 * k[6];
    const zd_real x20 = p1 * k[6];
    const zd_real x40 = k[1] * x20;
    const zd_real x46 = ZD_FMA(x19, k[1] * x19, x20 * x40);
    const zd_real x48 = 1.0 / (x19 * x46);
    const zd_real x49 = x46 * x48;
    const zd_real x68 = ZD_FNMA(k[7], ZD_FMA(v1, v1, v0 * v0) * 2.0, added0);
    const zd_real x77 = x48 * (x19 * ZD_FNMA(x19, k[5] * x19, x40 * x68));
    const zd_real x83 = ZD_FNMA(x77, x20 * x49, x49 * x68);
    vdot[0] = x83;
    vdot[1] = x77;
    /* lambda (8); power (28) */
    if (lambda || power) {
        if (lambda) lambda[0] = -(x49 * (k[1] * x83));
        if (power) power[0] = ZD_SPLAT(0.0);
    }
    if (pivots) {
        pivots[0] = x19;
        pivots[1] = ZD_SPLAT(1.0);
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
    const zd_real p0 = p[0], p1 = p[1];
    const zd_real v0 = v[0], v1 = v[1];
    /* Phi (3); dp (25a), (26a), (27a); dv (25b), (26b), (27b) */
    const zd_real x18 = ZD_FMA(p1, p1, ZD_FMS(p0, p0, k[8])) * k[7];
    const zd_real x19 = p0 * k[6];
    const zd_real x20 = p1 * k[6];
    const zd_real x40 = k[1] * x20;
    const zd_real x46 = ZD_FMA(x19, k[1] * x19, x20 * x40);
    const zd_real x48 = 1.0 / (x19 * x46);
    const zd_real x49 = x46 * x48;
    const zd_real x79 = x20 * x49;
    const zd_real x95 = ZD_FMA(x20, v1, x19 * v0);
    const zd_real x99 = x48 * (x19 * (x18 * x40));
    const zd_real x108 = x48 * (x19 * (x40 * x95));
    Phi[0] = x18;
    dp[0] = ZD_FNMA(x79, x99, x18 * x49);
    dp[1] = x99;
    dv[0] = ZD_FNMA(x79, x108, x49 * x95);
    dv[1] = x108;
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
    const zd_real p0 = p[0], p1 = p[1];
    const zd_real before0 = v[0], before1 = v[1];
    /* Phi (3) */
    const zd_real x18 = ZD_FMA(p1, p1, ZD_FMS(p0, p0, k[8])) * k[7];
    Phi[0] = x18;
    if (!(fabs(Phi[0]) <= allowed[0])) {
        /* dp (25a), (26a), (27a) */
        const zd_real x19 = p0 * k[6];
        const zd_real x20 = p1 * k[6];
        const zd_real x40 = k[1] * x20;
        const zd_real x46 = ZD_FMA(x19, k[1] * x19, x20 * x40);
        const zd_real x48 = 1.0 / (x19 * x46);
        const zd_real x49 = x46 * x48;
        const zd_real x79 = x20 * x49;
        const zd_real x99 = x48 * (x19 * (x18 * x40));
        dp[0] = ZD_FNMA(x79, x99, x18 * x49);
        dp[1] = x99;
        return ZD_NO_CONVERGENCE;
    }
    /* dv (25b), (26b), (27b) */
    const zd_real x19 = p0 * k[6];
    const zd_real x20 = p1 * k[6];
    const zd_real x40 = k[1] * x20;
    const zd_real x46 = ZD_FMA(x19, k[1] * x19, x20 * x40);
    const zd_real x48 = 1.0 / (x19 * x46);
    const zd_real x49 = x46 * x48;
    const zd_real x79 = x20 * x49;
    const zd_real x118 = ZD_FMA(x20, before1, x19 * before0);
    const zd_real x122 = x48 * (x19 * (x40 * x118));
    const zd_real v0 = before0 - ZD_FNMA(x79, x122, x49 * x118);
    const zd_real v1 = before1 - x122;
    /* vdot (17) */
    const zd_real x28 = k[7] * (ZD_FMA(v1, v1, v0 * v0) * 2.0);
    const zd_real x134 = x48 * (x19 * ZD_FMA(x28, x40, x19 * (k[5] * x19)));
    const zd_real x140 = ZD_FNMA(x28, x49, x79 * x134);
    v[0] = v0;
    v[1] = v1;
    vdot[0] = x140;
    vdot[1] = -x134;
    /* lambda (8); power (28) */
    if (lambda || power) {
        if (lambda) lambda[0] = -(x49 * (k[1] * x140));
        if (power) power[0] = ZD_SPLAT(0.0);
    }
    if (pivots) {
        pivots[0] = x19;
        pivots[1] = ZD_SPLAT(1.0);
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
    const zd_real p0 = p[0], p1 = p[1];
    const zd_real v0 = v[0], v1 = v[1];
    const zd_real added0 = added ? (zd_real)added[0] : ZD_SPLAT(0.0);
    /* vdot (17) */
    const zd_real x19 = p0 * k[6];
    const zd_real x20 = p1 * k[6];
    const zd_real x42 = k[1] * x19;
    const zd_real x46 = ZD_FMA(x19, x42, x20 * (k[1] * x20));
    const zd_real x64 = 1.0 / (x20 * x46);
    const zd_real x65 = x46 * x64;
    const zd_real x68 = ZD_FNMA(k[7], ZD_FMA(v1, v1, v0 * v0) * 2.0, added0);
    const zd_real x155 = x64 * (x20 * ZD_FMA(x20, k[5] * x19, x42 * x68));
    const zd_real x163 = ZD_FNMA(x155, x19 * x65, x65 * x68);
    vdot[0] = x155;
    vdot[1] = x163;
    /* lambda (8); power (28) */
    if (lambda || power) {
        if (lambda) lambda[0] = -(x65 * ZD_FMA(k[1], x163, k[5]));
        if (power) power[0] = ZD_SPLAT(0.0);
    }
    if (pivots) {
        pivots[0] = x20;
        pivots[1] = ZD_SPLAT(1.0);
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
    const zd_real p0 = p[0], p1 = p[1];
    const zd_real v0 = v[0], v1 = v[1];
    /* Phi (3); dp (25a), (26a), (27a); dv (25b), (26b), (27b) */
    const zd_real x18 = ZD_FMA(p1, p1, ZD_FMS(p0, p0, k[8])) * k[7];
    const zd_real x19 = p0 * k[6];
    const zd_real x20 = p1 * k[6];
    const zd_real x42 = k[1] * x19;
    const zd_real x46 = ZD_FMA(x19, x42, x20 * (k[1] * x20));
    const zd_real x64 = 1.0 / (x20 * x46);
    const zd_real x65 = x46 * x64;
    const zd_real x95 = ZD_FMA(x20, v1, x19 * v0);
    const zd_real x159 = x19 * x65;
    const zd_real x174 = x64 * (x20 * (x18 * x42));
    const zd_real x183 = x64 * (x20 * (x42 * x95));
    Phi[0] = x18;
    dp[0] = x174;
    dp[1] = ZD_FNMA(x159, x174, x18 * x65);
    dv[0] = x183;
    dv[1] = ZD_FNMA(x159, x183, x65 * x95);
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
    const zd_real p0 = p[0], p1 = p[1];
    const zd_real before0 = v[0], before1 = v[1];
    /* Phi (3) */
    const zd_real x18 = ZD_FMA(p1, p1, ZD_FMS(p0, p0, k[8])) * k[7];
    Phi[0] = x18;
    if (!(fabs(Phi[0]) <= allowed[0])) {
        /* dp (25a), (26a), (27a) */
        const zd_real x19 = p0 * k[6];
        const zd_real x20 = p1 * k[6];
        const zd_real x42 = k[1] * x19;
        const zd_real x46 = ZD_FMA(x19, x42, x20 * (k[1] * x20));
        const zd_real x64 = 1.0 / (x20 * x46);
        const zd_real x65 = x46 * x64;
        const zd_real x159 = x19 * x65;
        const zd_real x174 = x64 * (x20 * (x18 * x42));
        dp[0] = x174;
        dp[1] = ZD_FNMA(x159, x174, x18 * x65);
        return ZD_NO_CONVERGENCE;
    }
    /* dv (25b), (26b), (27b) */
    const zd_real x19 = p0 * k[6];
    const zd_real x20 = p1 * k[6];
    const zd_real x42 = k[1] * x19;
    const zd_real x46 = ZD_FMA(x19, x42, x20 * (k[1] * x20));
    const zd_real x64 = 1.0 / (x20 * x46);
    const zd_real x65 = x46 * x64;
    const zd_real x118 = ZD_FMA(x20, before1, x19 * before0);
    const zd_real x159 = x19 * x65;
    const zd_real x192 = x64 * (x20 * (x42 * x118));
    const zd_real v0 = before0 - x192;
    const zd_real v1 = before1 - ZD_FNMA(x159, x192, x65 * x118);
    /* vdot (17) */
    const zd_real x28 = k[7] * (ZD_FMA(v1, v1, v0 * v0) * 2.0);
    const zd_real x202 = x64 * (x20 * ZD_FNMA(x28, x42, x20 * (k[5] * x19)));
    const zd_real x208 = ZD_FMA(x159, x202, x28 * x65);
    v[0] = v0;
    v[1] = v1;
    vdot[0] = x202;
    vdot[1] = -x208;
    /* lambda (8); power (28) */
    if (lambda || power) {
        if (lambda) lambda[0] = x65 * ZD_FMS(k[1], x208, k[5]);
        if (power) power[0] = ZD_SPLAT(0.0);
    }
    if (pivots) {
        pivots[0] = x20;
        pivots[1] = ZD_SPLAT(1.0);
    }
    return ZD_DONE;
}
#endif

#if ZD_LANES == 1
ZD_ON_UNIT static int ZD_NAMED(correct_2)(const zd_elimination *self, const void *data, const double *at_inputs, const double *at_time, const double *at_p,
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
    const zd_real p0 = p[0], p1 = p[1];
    const zd_real v0 = v[0], v1 = v[1];
    /* Phi (3); dp (25a), (26a), (27a); dv (25b), (26b), (27b) */
    const zd_real x18 = ZD_FMA(p1, p1, ZD_FMS(p0, p0, k[8])) * k[7];
    const zd_real x19 = p0 * k[6];
    const zd_real x20 = p1 * k[6];
    const zd_real x40 = k[1] * x20;
    const zd_real x46 = ZD_FMA(x19, k[1] * x19, x20 * x40);
    const zd_real x48 = 1.0 / (x19 * x46);
    const zd_real x49 = x46 * x48;
    const zd_real x79 = x20 * x49;
    const zd_real x95 = ZD_FMA(x20, v1, x19 * v0);
    const zd_real x99 = x48 * (x19 * (x18 * x40));
    const zd_real x108 = x48 * (x19 * (x40 * x95));
    Phi[0] = x18;
    dp[0] = ZD_FNMA(x79, x99, x18 * x49);
    dp[1] = x99;
    dv[0] = ZD_FNMA(x79, x108, x49 * x95);
    dv[1] = x108;
    return ZD_DONE;
}
#endif

#if ZD_LANES == 1
ZD_ON_UNIT static int ZD_NAMED(embed_2)(const zd_elimination *self, const void *data, const double *at_inputs, const double *at_time, const double *at_p,
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
    (void)self, (void)t, (void)k, (void)input, (void)time, (void)p, (void)allowed, (void)added, (void)v, (void)Phi, (void)dp, (void)D, (void)pdot, (void)vdot, (void)lambda, (void)power, (void)pivots;
    const zd_real p0 = p[0], p1 = p[1];
    const zd_real before0 = v[0], before1 = v[1];
    const zd_real added0 = added ? (zd_real)added[0] : ZD_SPLAT(0.0);
    /* Phi (3) */
    const zd_real x18 = ZD_FMA(p1, p1, ZD_FMS(p0, p0, k[8])) * k[7];
    Phi[0] = x18;
    if (!(fabs(Phi[0]) <= allowed[0])) {
        /* dp (18) */
        const zd_real x19 = p0 * k[6];
        const zd_real x20 = p1 * k[6];
        const zd_real x40 = k[1] * x20;
        const zd_real x46 = ZD_FMA(x19, k[1] * x19, x20 * x40);
        const zd_real x48 = 1.0 / (x19 * x46);
        const zd_real x49 = x46 * x48;
        dp[0] = x18 * x49;
        dp[1] = ZD_SPLAT(0.0);
        return ZD_NO_CONVERGENCE;
    }
    /* dv (14), (16) */
    const zd_real x19 = p0 * k[6];
    const zd_real x20 = p1 * k[6];
    const zd_real x40 = k[1] * x20;
    const zd_real x46 = ZD_FMA(x19, k[1] * x19, x20 * x40);
    const zd_real x48 = 1.0 / (x19 * x46);
    const zd_real x49 = x46 * x48;
    const zd_real v0 = before0 - (x49 * ZD_FMA(x20, before1, x19 * before0));
    const zd_real v1 = before1;
    /* vdot (17) */
    const zd_real x68 = ZD_FNMA(k[7], ZD_FMA(v1, v1, v0 * v0) * 2.0, added0);
    const zd_real x77 = x48 * (x19 * ZD_FNMA(x19, k[5] * x19, x40 * x68));
    const zd_real x79 = x20 * x49;
    const zd_real x83 = ZD_FNMA(x77, x79, x49 * x68);
    v[0] = v0;
    v[1] = v1;
    vdot[0] = x83;
    vdot[1] = x77;
    /* lambda (8); power (28) */
    if (lambda || power) {
        if (lambda) lambda[0] = -(x49 * (k[1] * x83));
        if (power) power[0] = ZD_SPLAT(0.0);
    }
    /* D (16) */
    if (pivots || D) {
        if (pivots) pivots[0] = x19;
        if (pivots) pivots[1] = ZD_SPLAT(1.0);
        if (D) D[0] = -x79;
    }
    return ZD_DONE;
}
#endif

#if ZD_LANES == 1
ZD_ON_UNIT static int ZD_NAMED(correct_3)(const zd_elimination *self, const void *data, const double *at_inputs, const double *at_time, const double *at_p,
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
    const zd_real p0 = p[0], p1 = p[1];
    const zd_real v0 = v[0], v1 = v[1];
    /* Phi (3); dp (25a), (26a), (27a); dv (25b), (26b), (27b) */
    const zd_real x18 = ZD_FMA(p1, p1, ZD_FMS(p0, p0, k[8])) * k[7];
    const zd_real x19 = p0 * k[6];
    const zd_real x20 = p1 * k[6];
    const zd_real x42 = k[1] * x19;
    const zd_real x46 = ZD_FMA(x19, x42, x20 * (k[1] * x20));
    const zd_real x64 = 1.0 / (x20 * x46);
    const zd_real x65 = x46 * x64;
    const zd_real x95 = ZD_FMA(x20, v1, x19 * v0);
    const zd_real x159 = x19 * x65;
    const zd_real x174 = x64 * (x20 * (x18 * x42));
    const zd_real x183 = x64 * (x20 * (x42 * x95));
    Phi[0] = x18;
    dp[0] = x174;
    dp[1] = ZD_FNMA(x159, x174, x18 * x65);
    dv[0] = x183;
    dv[1] = ZD_FNMA(x159, x183, x65 * x95);
    return ZD_DONE;
}
#endif

#if ZD_LANES == 1
ZD_ON_UNIT static int ZD_NAMED(embed_3)(const zd_elimination *self, const void *data, const double *at_inputs, const double *at_time, const double *at_p,
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
    (void)self, (void)t, (void)k, (void)input, (void)time, (void)p, (void)allowed, (void)added, (void)v, (void)Phi, (void)dp, (void)D, (void)pdot, (void)vdot, (void)lambda, (void)power, (void)pivots;
    const zd_real p0 = p[0], p1 = p[1];
    const zd_real before0 = v[0], before1 = v[1];
    const zd_real added0 = added ? (zd_real)added[0] : ZD_SPLAT(0.0);
    /* Phi (3) */
    const zd_real x18 = ZD_FMA(p1, p1, ZD_FMS(p0, p0, k[8])) * k[7];
    Phi[0] = x18;
    if (!(fabs(Phi[0]) <= allowed[0])) {
        /* dp (18) */
        const zd_real x19 = p0 * k[6];
        const zd_real x20 = p1 * k[6];
        const zd_real x42 = k[1] * x19;
        const zd_real x46 = ZD_FMA(x19, x42, x20 * (k[1] * x20));
        const zd_real x64 = 1.0 / (x20 * x46);
        const zd_real x65 = x46 * x64;
        dp[0] = ZD_SPLAT(0.0);
        dp[1] = x18 * x65;
        return ZD_NO_CONVERGENCE;
    }
    /* dv (14), (16) */
    const zd_real x19 = p0 * k[6];
    const zd_real x20 = p1 * k[6];
    const zd_real x42 = k[1] * x19;
    const zd_real x46 = ZD_FMA(x19, x42, x20 * (k[1] * x20));
    const zd_real x64 = 1.0 / (x20 * x46);
    const zd_real x65 = x46 * x64;
    const zd_real v0 = before0;
    const zd_real v1 = before1 - (x65 * ZD_FMA(x20, before1, x19 * before0));
    /* vdot (17) */
    const zd_real x68 = ZD_FNMA(k[7], ZD_FMA(v1, v1, v0 * v0) * 2.0, added0);
    const zd_real x155 = x64 * (x20 * ZD_FMA(x20, k[5] * x19, x42 * x68));
    const zd_real x159 = x19 * x65;
    const zd_real x163 = ZD_FNMA(x155, x159, x65 * x68);
    v[0] = v0;
    v[1] = v1;
    vdot[0] = x155;
    vdot[1] = x163;
    /* lambda (8); power (28) */
    if (lambda || power) {
        if (lambda) lambda[0] = -(x65 * ZD_FMA(k[1], x163, k[5]));
        if (power) power[0] = ZD_SPLAT(0.0);
    }
    /* D (16) */
    if (pivots || D) {
        if (pivots) pivots[0] = x20;
        if (pivots) pivots[1] = ZD_SPLAT(1.0);
        if (D) D[0] = -x159;
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
#if ZD_LANES == 1
static const zd_elimination ZD_NAMED(embeddings)[] = {
    {1, solve_2, row_2, column_2, NULL, ZD_NAMED(correct_2), NULL, ZD_NAMED(embed_2), NULL},
    {1, solve_3, row_3, column_3, NULL, ZD_NAMED(correct_3), NULL, ZD_NAMED(embed_3), NULL},
};
#endif

#undef ZD_UNIT
#undef ZD_LANES
#endif
