/* Written by tests/direct_sources.py with SymPy 1.14.0, from tests/symbolic_counterparts.py. */
#include "pendulum.h"

#include <math.h>
#include "../../include/zerodrift/sines.h"

/* What follows from the parameters alone, behind them. */
void zd_pendulum_direct_constants(double *k)
{
    k[5] = k[1] * k[2];
    k[8] = k[0] * k[0];
    k[6] = 1.0 / k[0];
    k[7] = k[6] * 0.5;
}

static int accelerate_0(const void *data, const double *restrict time, const double *restrict p,
    const double *restrict v, const double *restrict added, double *restrict pdot, double *restrict vdot,
    double *restrict lambda, double *restrict power, double *restrict pivots)
{
    const double *restrict const k = data;
    const double t = *time;
    (void)k, (void)t, (void)p, (void)v;
    (void)added, (void)pdot, (void)lambda, (void)power, (void)pivots;
    const double p0 = p[0], p1 = p[1];
    const double v0 = v[0], v1 = v[1];
    const double added0 = added ? added[0] : 0;
    const double x18 = p0 * k[6];
    const double x31 = 1.0 / x18;
    const double x33 = (p1 * k[6]) * x31;
    const double x35 = k[1] * x33;
    const double x55 = x31 * (added0 - (k[7] * (((v0 * v0) + (v1 * v1)) * 2.0)));
    const double x59 = (1.0 / (k[1] + (x33 * x35))) * ((x35 * x55) - k[5]);
    const double x62 = x55 - (x33 * x59);
    vdot[0] = x62;
    vdot[1] = x59;
    if (lambda || power) {
        if (lambda) lambda[0] = -(x31 * (k[1] * x62));
        if (power) power[0] = 0.0;
    }
    if (pivots) {
        pivots[0] = x18;
        pivots[1] = 1.0;
    }
    return ZD_DONE;
}

static int correct_0(const void *data, const double *restrict time, const double *restrict p,
    const double *restrict v, double *restrict Phi, double *restrict dp, double *restrict dv)
{
    const double *restrict const k = data;
    const double t = *time;
    (void)k, (void)t, (void)p, (void)v;
    (void)Phi;
    const double p0 = p[0], p1 = p[1];
    const double v0 = v[0], v1 = v[1];
    const double x17 = ((p1 * p1) + ((p0 * p0) - k[8])) * k[7];
    const double x18 = p0 * k[6];
    const double x19 = p1 * k[6];
    const double x31 = 1.0 / x18;
    const double x33 = x19 * x31;
    const double x35 = k[1] * x33;
    const double x40 = 1.0 / (k[1] + (x33 * x35));
    const double x73 = x17 * x31;
    const double x76 = x40 * (x35 * x73);
    const double x80 = x31 * ((x18 * v0) + (x19 * v1));
    const double x83 = x40 * (x35 * x80);
    Phi[0] = x17;
    dp[0] = x73 - (x33 * x76);
    dp[1] = x76;
    dv[0] = x80 - (x33 * x83);
    dv[1] = x83;
    return ZD_DONE;
}

static int land_0(const void *data, const double *restrict time, const double *restrict p,
    double *restrict v, const double *restrict allowed, double *restrict Phi, double *restrict dp,
    double *restrict pdot, double *restrict vdot, double *restrict lambda, double *restrict power, double *restrict pivots)
{
    const double *restrict const k = data;
    const double t = *time;
    (void)k, (void)t, (void)p, (void)v;
    (void)allowed, (void)Phi, (void)dp, (void)pdot, (void)lambda, (void)power, (void)pivots;
    const double p0 = p[0], p1 = p[1];
    const double before0 = v[0], before1 = v[1];
    const double x17 = ((p1 * p1) + ((p0 * p0) - k[8])) * k[7];
    Phi[0] = x17;
    if (!(fabs(Phi[0]) <= allowed[0])) {
        const double x18 = p0 * k[6];
        const double x19 = p1 * k[6];
        const double x31 = 1.0 / x18;
        const double x33 = x19 * x31;
        const double x35 = k[1] * x33;
        const double x40 = 1.0 / (k[1] + (x33 * x35));
        const double x73 = x17 * x31;
        const double x76 = x40 * (x35 * x73);
        dp[0] = x73 - (x33 * x76);
        dp[1] = x76;
        return ZD_NO_CONVERGENCE;
    }
    const double x18 = p0 * k[6];
    const double x19 = p1 * k[6];
    const double x31 = 1.0 / x18;
    const double x33 = x19 * x31;
    const double x35 = k[1] * x33;
    const double x40 = 1.0 / (k[1] + (x33 * x35));
    const double x92 = x31 * ((x18 * before0) + (x19 * before1));
    const double x95 = x40 * (x35 * x92);
    const double v0 = before0 - (x92 - (x33 * x95));
    const double v1 = before1 - x95;
    const double x99 = (k[7] * (((v0 * v0) + (v1 * v1)) * 2.0)) * x31;
    const double x105 = x40 * (k[5] + (x35 * x99));
    const double x109 = (x33 * x105) - x99;
    v[0] = v0;
    v[1] = v1;
    vdot[0] = x109;
    vdot[1] = -x105;
    if (lambda || power) {
        if (lambda) lambda[0] = -(x31 * (k[1] * x109));
        if (power) power[0] = 0.0;
    }
    if (pivots) {
        pivots[0] = x18;
        pivots[1] = 1.0;
    }
    return ZD_DONE;
}

static int accelerate_1(const void *data, const double *restrict time, const double *restrict p,
    const double *restrict v, const double *restrict added, double *restrict pdot, double *restrict vdot,
    double *restrict lambda, double *restrict power, double *restrict pivots)
{
    const double *restrict const k = data;
    const double t = *time;
    (void)k, (void)t, (void)p, (void)v;
    (void)added, (void)pdot, (void)lambda, (void)power, (void)pivots;
    const double p0 = p[0], p1 = p[1];
    const double v0 = v[0], v1 = v[1];
    const double added0 = added ? added[0] : 0;
    const double x19 = p1 * k[6];
    const double x42 = 1.0 / x19;
    const double x44 = (p0 * k[6]) * x42;
    const double x46 = k[1] * x44;
    const double x117 = x42 * (added0 - (k[7] * (((v0 * v0) + (v1 * v1)) * 2.0)));
    const double x123 = (1.0 / (k[1] + (x44 * x46))) * ((x46 * x117) + (k[5] * x44));
    const double x126 = x117 - (x44 * x123);
    vdot[0] = x123;
    vdot[1] = x126;
    if (lambda || power) {
        if (lambda) lambda[0] = -(x42 * (k[5] + (k[1] * x126)));
        if (power) power[0] = 0.0;
    }
    if (pivots) {
        pivots[0] = x19;
        pivots[1] = 1.0;
    }
    return ZD_DONE;
}

static int correct_1(const void *data, const double *restrict time, const double *restrict p,
    const double *restrict v, double *restrict Phi, double *restrict dp, double *restrict dv)
{
    const double *restrict const k = data;
    const double t = *time;
    (void)k, (void)t, (void)p, (void)v;
    (void)Phi;
    const double p0 = p[0], p1 = p[1];
    const double v0 = v[0], v1 = v[1];
    const double x17 = ((p1 * p1) + ((p0 * p0) - k[8])) * k[7];
    const double x18 = p0 * k[6];
    const double x19 = p1 * k[6];
    const double x42 = 1.0 / x19;
    const double x44 = x18 * x42;
    const double x46 = k[1] * x44;
    const double x51 = 1.0 / (k[1] + (x44 * x46));
    const double x134 = x17 * x42;
    const double x137 = x51 * (x46 * x134);
    const double x141 = x42 * ((x18 * v0) + (x19 * v1));
    const double x144 = x51 * (x46 * x141);
    Phi[0] = x17;
    dp[0] = x137;
    dp[1] = x134 - (x44 * x137);
    dv[0] = x144;
    dv[1] = x141 - (x44 * x144);
    return ZD_DONE;
}

static int land_1(const void *data, const double *restrict time, const double *restrict p,
    double *restrict v, const double *restrict allowed, double *restrict Phi, double *restrict dp,
    double *restrict pdot, double *restrict vdot, double *restrict lambda, double *restrict power, double *restrict pivots)
{
    const double *restrict const k = data;
    const double t = *time;
    (void)k, (void)t, (void)p, (void)v;
    (void)allowed, (void)Phi, (void)dp, (void)pdot, (void)lambda, (void)power, (void)pivots;
    const double p0 = p[0], p1 = p[1];
    const double before0 = v[0], before1 = v[1];
    const double x17 = ((p1 * p1) + ((p0 * p0) - k[8])) * k[7];
    Phi[0] = x17;
    if (!(fabs(Phi[0]) <= allowed[0])) {
        const double x18 = p0 * k[6];
        const double x19 = p1 * k[6];
        const double x42 = 1.0 / x19;
        const double x44 = x18 * x42;
        const double x46 = k[1] * x44;
        const double x51 = 1.0 / (k[1] + (x44 * x46));
        const double x134 = x17 * x42;
        const double x137 = x51 * (x46 * x134);
        dp[0] = x137;
        dp[1] = x134 - (x44 * x137);
        return ZD_NO_CONVERGENCE;
    }
    const double x18 = p0 * k[6];
    const double x19 = p1 * k[6];
    const double x42 = 1.0 / x19;
    const double x44 = x18 * x42;
    const double x46 = k[1] * x44;
    const double x51 = 1.0 / (k[1] + (x44 * x46));
    const double x148 = x42 * ((x18 * before0) + (x19 * before1));
    const double x151 = x51 * (x46 * x148);
    const double v0 = before0 - x151;
    const double v1 = before1 - (x148 - (x44 * x151));
    const double x155 = (k[7] * (((v0 * v0) + (v1 * v1)) * 2.0)) * x42;
    const double x160 = x51 * ((k[5] * x44) - (x46 * x155));
    const double x163 = x155 + (x44 * x160);
    v[0] = v0;
    v[1] = v1;
    vdot[0] = x160;
    vdot[1] = -x163;
    if (lambda || power) {
        if (lambda) lambda[0] = x42 * ((k[1] * x163) - k[5]);
        if (power) power[0] = 0.0;
    }
    if (pivots) {
        pivots[0] = x19;
        pivots[1] = 1.0;
    }
    return ZD_DONE;
}

static const int solve_0[] = {0};
static const int row_0[] = {0};
static const int column_0[] = {0};
static const int solve_1[] = {0};
static const int row_1[] = {0};
static const int column_1[] = {1};

static const zd_elimination orders[] = {
    {1, solve_0, row_0, column_0, accelerate_0, correct_0, land_0},
    {1, solve_1, row_1, column_1, accelerate_1, correct_1, land_1},
};

const zd_direct zd_pendulum_direct = {ZD_BASELINE, 1, 2, orders};
