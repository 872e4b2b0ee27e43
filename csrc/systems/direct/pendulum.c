/* Written by tests/direct_sources.py with SymPy 1.14.0, from tests/symbolic_counterparts.py. */
#ifndef ZD_LANES
#include "pendulum.h"

#include <math.h>
#include "../../include/zerodrift/units.h"

/* What follows from the parameters alone, behind them. */
void zd_pendulum_direct_constants(double *k)
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

const zd_direct zd_pendulum_direct[] = {
#if (ZD_SETS) & ZD_SET_BASELINE_1
    {0, 1, 2, orders_0_1},
#endif
#if (ZD_SETS) & ZD_SET_BASELINE_2
    {0, 2, 2, orders_0_2},
#endif
#if (ZD_SETS) & ZD_SET_AVX2_1
    {1, 1, 2, orders_1_1},
#endif
#if (ZD_SETS) & ZD_SET_AVX2_4
    {1, 4, 2, orders_1_4},
#endif
#if (ZD_SETS) & ZD_SET_AVX512_1
    {2, 1, 2, orders_2_1},
#endif
#if (ZD_SETS) & ZD_SET_AVX512_8
    {2, 8, 2, orders_2_8},
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
    const zd_real p0 = p[0], p1 = p[1];
    const zd_real v0 = v[0], v1 = v[1];
    const zd_real added0 = added ? (zd_real)added[0] : ZD_SPLAT(0.0);
    const zd_real x18 = p0 * k[6];
    const zd_real x31 = 1.0 / x18;
    const zd_real x33 = (p1 * k[6]) * x31;
    const zd_real x35 = k[1] * x33;
    const zd_real x55 = x31 * ZD_FNMA(k[7], ZD_FMA(v1, v1, v0 * v0) * 2.0, added0);
    const zd_real x59 = (1.0 / ZD_FMA(x33, x35, k[1])) * ZD_FMS(x35, x55, k[5]);
    const zd_real x62 = ZD_FNMA(x33, x59, x55);
    vdot[0] = x62;
    vdot[1] = x59;
    if (lambda || power) {
        if (lambda) lambda[0] = -(x31 * (k[1] * x62));
        if (power) power[0] = ZD_SPLAT(0.0);
    }
    if (pivots) {
        pivots[0] = x18;
        pivots[1] = ZD_SPLAT(1.0);
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
    const zd_real p0 = p[0], p1 = p[1];
    const zd_real v0 = v[0], v1 = v[1];
    const zd_real x17 = ZD_FMA(p1, p1, ZD_FMS(p0, p0, k[8])) * k[7];
    const zd_real x18 = p0 * k[6];
    const zd_real x19 = p1 * k[6];
    const zd_real x31 = 1.0 / x18;
    const zd_real x33 = x19 * x31;
    const zd_real x35 = k[1] * x33;
    const zd_real x40 = 1.0 / ZD_FMA(x33, x35, k[1]);
    const zd_real x73 = x17 * x31;
    const zd_real x76 = x40 * (x35 * x73);
    const zd_real x80 = x31 * ZD_FMA(x19, v1, x18 * v0);
    const zd_real x83 = x40 * (x35 * x80);
    Phi[0] = x17;
    dp[0] = ZD_FNMA(x33, x76, x73);
    dp[1] = x76;
    dv[0] = ZD_FNMA(x33, x83, x80);
    dv[1] = x83;
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
    const zd_real p0 = p[0], p1 = p[1];
    const zd_real before0 = v[0], before1 = v[1];
    const zd_real x17 = ZD_FMA(p1, p1, ZD_FMS(p0, p0, k[8])) * k[7];
    Phi[0] = x17;
    if (!(fabs(Phi[0]) <= allowed[0])) {
        const zd_real x18 = p0 * k[6];
        const zd_real x19 = p1 * k[6];
        const zd_real x31 = 1.0 / x18;
        const zd_real x33 = x19 * x31;
        const zd_real x35 = k[1] * x33;
        const zd_real x40 = 1.0 / ZD_FMA(x33, x35, k[1]);
        const zd_real x73 = x17 * x31;
        const zd_real x76 = x40 * (x35 * x73);
        dp[0] = ZD_FNMA(x33, x76, x73);
        dp[1] = x76;
        return ZD_NO_CONVERGENCE;
    }
    const zd_real x18 = p0 * k[6];
    const zd_real x19 = p1 * k[6];
    const zd_real x31 = 1.0 / x18;
    const zd_real x33 = x19 * x31;
    const zd_real x35 = k[1] * x33;
    const zd_real x40 = 1.0 / ZD_FMA(x33, x35, k[1]);
    const zd_real x92 = x31 * ZD_FMA(x19, before1, x18 * before0);
    const zd_real x95 = x40 * (x35 * x92);
    const zd_real v0 = before0 - ZD_FNMA(x33, x95, x92);
    const zd_real v1 = before1 - x95;
    const zd_real x99 = (k[7] * (ZD_FMA(v1, v1, v0 * v0) * 2.0)) * x31;
    const zd_real x105 = x40 * ZD_FMA(x35, x99, k[5]);
    const zd_real x109 = ZD_FMS(x33, x105, x99);
    v[0] = v0;
    v[1] = v1;
    vdot[0] = x109;
    vdot[1] = -x105;
    if (lambda || power) {
        if (lambda) lambda[0] = -(x31 * (k[1] * x109));
        if (power) power[0] = ZD_SPLAT(0.0);
    }
    if (pivots) {
        pivots[0] = x18;
        pivots[1] = ZD_SPLAT(1.0);
    }
    return ZD_DONE;
}
#endif

ZD_ON_UNIT static int ZD_NAMED(accelerate_1)(const void *data, const double *at_time, const double *at_p,
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
    const zd_real p0 = p[0], p1 = p[1];
    const zd_real v0 = v[0], v1 = v[1];
    const zd_real added0 = added ? (zd_real)added[0] : ZD_SPLAT(0.0);
    const zd_real x19 = p1 * k[6];
    const zd_real x42 = 1.0 / x19;
    const zd_real x44 = (p0 * k[6]) * x42;
    const zd_real x46 = k[1] * x44;
    const zd_real x117 = x42 * ZD_FNMA(k[7], ZD_FMA(v1, v1, v0 * v0) * 2.0, added0);
    const zd_real x123 = (1.0 / ZD_FMA(x44, x46, k[1])) * ZD_FMA(k[5], x44, x46 * x117);
    const zd_real x126 = ZD_FNMA(x44, x123, x117);
    vdot[0] = x123;
    vdot[1] = x126;
    if (lambda || power) {
        if (lambda) lambda[0] = -(x42 * ZD_FMA(k[1], x126, k[5]));
        if (power) power[0] = ZD_SPLAT(0.0);
    }
    if (pivots) {
        pivots[0] = x19;
        pivots[1] = ZD_SPLAT(1.0);
    }
    return ZD_DONE;
}

ZD_ON_UNIT static int ZD_NAMED(correct_1)(const void *data, const double *at_time, const double *at_p,
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
    const zd_real p0 = p[0], p1 = p[1];
    const zd_real v0 = v[0], v1 = v[1];
    const zd_real x17 = ZD_FMA(p1, p1, ZD_FMS(p0, p0, k[8])) * k[7];
    const zd_real x18 = p0 * k[6];
    const zd_real x19 = p1 * k[6];
    const zd_real x42 = 1.0 / x19;
    const zd_real x44 = x18 * x42;
    const zd_real x46 = k[1] * x44;
    const zd_real x51 = 1.0 / ZD_FMA(x44, x46, k[1]);
    const zd_real x134 = x17 * x42;
    const zd_real x137 = x51 * (x46 * x134);
    const zd_real x141 = x42 * ZD_FMA(x19, v1, x18 * v0);
    const zd_real x144 = x51 * (x46 * x141);
    Phi[0] = x17;
    dp[0] = x137;
    dp[1] = ZD_FNMA(x44, x137, x134);
    dv[0] = x144;
    dv[1] = ZD_FNMA(x44, x144, x141);
    return ZD_DONE;
}

#if ZD_LANES == 1
ZD_ON_UNIT static int ZD_NAMED(land_1)(const void *data, const double *at_time, const double *at_p,
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
    const zd_real p0 = p[0], p1 = p[1];
    const zd_real before0 = v[0], before1 = v[1];
    const zd_real x17 = ZD_FMA(p1, p1, ZD_FMS(p0, p0, k[8])) * k[7];
    Phi[0] = x17;
    if (!(fabs(Phi[0]) <= allowed[0])) {
        const zd_real x18 = p0 * k[6];
        const zd_real x19 = p1 * k[6];
        const zd_real x42 = 1.0 / x19;
        const zd_real x44 = x18 * x42;
        const zd_real x46 = k[1] * x44;
        const zd_real x51 = 1.0 / ZD_FMA(x44, x46, k[1]);
        const zd_real x134 = x17 * x42;
        const zd_real x137 = x51 * (x46 * x134);
        dp[0] = x137;
        dp[1] = ZD_FNMA(x44, x137, x134);
        return ZD_NO_CONVERGENCE;
    }
    const zd_real x18 = p0 * k[6];
    const zd_real x19 = p1 * k[6];
    const zd_real x42 = 1.0 / x19;
    const zd_real x44 = x18 * x42;
    const zd_real x46 = k[1] * x44;
    const zd_real x51 = 1.0 / ZD_FMA(x44, x46, k[1]);
    const zd_real x148 = x42 * ZD_FMA(x19, before1, x18 * before0);
    const zd_real x151 = x51 * (x46 * x148);
    const zd_real v0 = before0 - x151;
    const zd_real v1 = before1 - ZD_FNMA(x44, x151, x148);
    const zd_real x155 = (k[7] * (ZD_FMA(v1, v1, v0 * v0) * 2.0)) * x42;
    const zd_real x160 = x51 * ZD_FNMA(x46, x155, k[5] * x44);
    const zd_real x163 = ZD_FMA(x44, x160, x155);
    v[0] = v0;
    v[1] = v1;
    vdot[0] = x160;
    vdot[1] = -x163;
    if (lambda || power) {
        if (lambda) lambda[0] = x42 * ZD_FMS(k[1], x163, k[5]);
        if (power) power[0] = ZD_SPLAT(0.0);
    }
    if (pivots) {
        pivots[0] = x19;
        pivots[1] = ZD_SPLAT(1.0);
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
    {1, solve_0, row_0, column_0, ZD_NAMED(accelerate_0), ZD_NAMED(correct_0), ZD_LANDING(land_0)},
    {1, solve_1, row_1, column_1, ZD_NAMED(accelerate_1), ZD_NAMED(correct_1), ZD_LANDING(land_1)},
};
#undef ZD_LANDING

#undef ZD_UNIT
#undef ZD_LANES
#endif
