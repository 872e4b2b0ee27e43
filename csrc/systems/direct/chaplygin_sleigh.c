/* Written by tests/direct_sources.py with SymPy 1.14.0, from tests/symbolic_counterparts.py. */
#include "chaplygin_sleigh.h"

#include <math.h>
#include "../../include/zerodrift/sines.h"

/* What follows from the parameters alone, behind them. */
void zd_chaplygin_sleigh_direct_constants(double *k)
{
    k[6] = k[0] * k[2];
    k[7] = k[1] + (k[0] * (k[2] * k[2]));
}

static int accelerate_0(const void *data, const double *restrict time, const double *restrict p,
    const double *restrict v, const double *restrict added, double *restrict pdot, double *restrict vdot,
    double *restrict lambda, double *restrict power, double *restrict pivots)
{
    const double *restrict const k = data;
    const double t = *time;
    (void)k, (void)t, (void)p, (void)v;
    (void)added, (void)pdot, (void)lambda, (void)power, (void)pivots;
    const double p2 = p[2];
    const double v0 = v[0], v1 = v[1], v2 = v[2];
    const double added0 = added ? added[0] : 0;
    const double x16 = v2 * v2;
    const double angle3[1] = {p2};
    double sine3[1], cosine3[1];
    zd_sines(1, angle3, sine3, cosine3);
    const double x7 = sine3[0] * k[6];
    const double x10 = k[6] * cosine3[0];
    const double x19 = x7 * x16;
    const double x29 = 1.0 / cosine3[0];
    const double x30 = sine3[0] * x29;
    const double x31 = k[0] * x30;
    const double x33 = (x10 * x30) - x7;
    const double x36 = 1.0 / (k[0] + (x30 * x31));
    const double x38 = x33 * x36;
    const double x39 = x33 * x38;
    const double x40 = k[7] - x39;
    const double x67 = x29 * ((v2 * ((sine3[0] * v1) + (cosine3[0] * v0))) + added0);
    const double x74 = ((x10 * x16) + (x19 * x30)) - (x31 * x67);
    const double x79 = (1.0 / x40) * ((x10 * x67) + (x38 * x74));
    const double x83 = (x36 * x74) + (x38 * x79);
    const double x85 = x67 + (x30 * x83);
    vdot[0] = x83;
    vdot[1] = x85;
    vdot[2] = -x79;
    if (lambda || power) {
        if (lambda) lambda[0] = x29 * (x19 - ((k[0] * x85) - (x10 * x79)));
        if (power) power[0] = 0.0;
    }
    if (pivots) {
        pivots[0] = cosine3[0];
        pivots[1] = 1.0;
        pivots[2] = x40 / (x39 + x40);
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
    const double p2 = p[2];
    const double v0 = v[0], v1 = v[1];
    const double angle3[1] = {p2};
    double sine3[1], cosine3[1];
    zd_sines(1, angle3, sine3, cosine3);
    const double x10 = k[6] * cosine3[0];
    const double x29 = 1.0 / cosine3[0];
    const double x30 = sine3[0] * x29;
    const double x31 = k[0] * x30;
    const double x33 = (x10 * x30) - (sine3[0] * k[6]);
    const double x36 = 1.0 / (k[0] + (x30 * x31));
    const double x38 = x33 * x36;
    const double x109 = x29 * ((cosine3[0] * v1) - (sine3[0] * v0));
    const double x110 = x31 * x109;
    const double x119 = (1.0 / (k[7] - (x33 * x38))) * ((x38 * x110) - (x10 * x109));
    const double x121 = (x36 * x110) + (x38 * x119);
    dp[0] = 0.0;
    dp[1] = 0.0;
    dp[2] = 0.0;
    dv[0] = -x121;
    dv[1] = x109 - (x30 * x121);
    dv[2] = x119;
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
    const double p2 = p[2];
    const double before0 = v[0], before1 = v[1], before2 = v[2];
    const double angle3[1] = {p2};
    double sine3[1], cosine3[1];
    zd_sines(1, angle3, sine3, cosine3);
    const double x7 = sine3[0] * k[6];
    const double x10 = k[6] * cosine3[0];
    const double x29 = 1.0 / cosine3[0];
    const double x30 = sine3[0] * x29;
    const double x31 = k[0] * x30;
    const double x33 = (x10 * x30) - x7;
    const double x36 = 1.0 / (k[0] + (x30 * x31));
    const double x38 = x33 * x36;
    const double x39 = x33 * x38;
    const double x40 = k[7] - x39;
    const double x41 = 1.0 / x40;
    const double x133 = x29 * ((cosine3[0] * before1) - (sine3[0] * before0));
    const double x134 = x31 * x133;
    const double x143 = x41 * ((x38 * x134) - (x10 * x133));
    const double x145 = (x36 * x134) + (x38 * x143);
    const double v0 = before0 - (-x145);
    const double v1 = before1 - (x133 - (x30 * x145));
    const double v2 = before2 - x143;
    const double x16 = v2 * v2;
    const double x19 = x7 * x16;
    const double x150 = (v2 * ((sine3[0] * v1) + (cosine3[0] * v0))) * x29;
    const double x155 = ((x10 * x16) + (x19 * x30)) - (x31 * x150);
    const double x160 = x41 * ((x10 * x150) + (x38 * x155));
    const double x164 = (x36 * x155) + (x38 * x160);
    const double x166 = x150 + (x30 * x164);
    v[0] = v0;
    v[1] = v1;
    v[2] = v2;
    vdot[0] = x164;
    vdot[1] = x166;
    vdot[2] = -x160;
    if (lambda || power) {
        if (lambda) lambda[0] = x29 * (x19 - ((k[0] * x166) - (x10 * x160)));
        if (power) power[0] = 0.0;
    }
    if (pivots) {
        pivots[0] = cosine3[0];
        pivots[1] = 1.0;
        pivots[2] = x40 / (x39 + x40);
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
    const double p2 = p[2];
    const double v0 = v[0], v1 = v[1], v2 = v[2];
    const double added0 = added ? added[0] : 0;
    const double x16 = v2 * v2;
    const double angle3[1] = {p2};
    double sine3[1], cosine3[1];
    zd_sines(1, angle3, sine3, cosine3);
    const double x7 = sine3[0] * k[6];
    const double x10 = k[6] * cosine3[0];
    const double x17 = x10 * x16;
    const double x45 = 1.0 / sine3[0];
    const double x48 = cosine3[0] * x45;
    const double x50 = k[0] * x48;
    const double x53 = x10 - (x7 * x48);
    const double x56 = 1.0 / (k[0] + (x48 * x50));
    const double x58 = x53 * x56;
    const double x59 = x53 * x58;
    const double x60 = k[7] - x59;
    const double x186 = x45 * ((v2 * ((sine3[0] * v1) + (cosine3[0] * v0))) + added0);
    const double x194 = (x50 * x186) + ((x7 * x16) + (x17 * x48));
    const double x199 = (1.0 / x60) * ((x7 * x186) + (x58 * x194));
    const double x203 = (x56 * x194) + (x58 * x199);
    const double x205 = (x48 * x203) - x186;
    vdot[0] = x205;
    vdot[1] = x203;
    vdot[2] = -x199;
    if (lambda || power) {
        if (lambda) lambda[0] = -(x45 * (x17 - ((k[0] * x205) + (x7 * x199))));
        if (power) power[0] = 0.0;
    }
    if (pivots) {
        pivots[0] = -sine3[0];
        pivots[1] = 1.0;
        pivots[2] = x60 / (x59 + x60);
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
    const double p2 = p[2];
    const double v0 = v[0], v1 = v[1];
    const double angle3[1] = {p2};
    double sine3[1], cosine3[1];
    zd_sines(1, angle3, sine3, cosine3);
    const double x7 = sine3[0] * k[6];
    const double x45 = 1.0 / sine3[0];
    const double x48 = cosine3[0] * x45;
    const double x50 = k[0] * x48;
    const double x53 = (k[6] * cosine3[0]) - (x7 * x48);
    const double x56 = 1.0 / (k[0] + (x48 * x50));
    const double x58 = x53 * x56;
    const double x226 = x45 * ((cosine3[0] * v1) - (sine3[0] * v0));
    const double x228 = x50 * x226;
    const double x236 = (1.0 / (k[7] - (x53 * x58))) * ((x7 * x226) + (x58 * x228));
    const double x240 = (x56 * x228) + (x58 * x236);
    dp[0] = 0.0;
    dp[1] = 0.0;
    dp[2] = 0.0;
    dv[0] = (x48 * x240) - x226;
    dv[1] = x240;
    dv[2] = -x236;
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
    const double p2 = p[2];
    const double before0 = v[0], before1 = v[1], before2 = v[2];
    const double angle3[1] = {p2};
    double sine3[1], cosine3[1];
    zd_sines(1, angle3, sine3, cosine3);
    const double x7 = sine3[0] * k[6];
    const double x10 = k[6] * cosine3[0];
    const double x45 = 1.0 / sine3[0];
    const double x48 = cosine3[0] * x45;
    const double x50 = k[0] * x48;
    const double x53 = x10 - (x7 * x48);
    const double x56 = 1.0 / (k[0] + (x48 * x50));
    const double x58 = x53 * x56;
    const double x59 = x53 * x58;
    const double x60 = k[7] - x59;
    const double x61 = 1.0 / x60;
    const double x243 = x45 * ((cosine3[0] * before1) - (sine3[0] * before0));
    const double x245 = x50 * x243;
    const double x253 = x61 * ((x7 * x243) + (x58 * x245));
    const double x257 = (x56 * x245) + (x58 * x253);
    const double v0 = before0 - ((x48 * x257) - x243);
    const double v1 = before1 - x257;
    const double v2 = before2 - (-x253);
    const double x16 = v2 * v2;
    const double x17 = x10 * x16;
    const double x260 = (v2 * ((sine3[0] * v1) + (cosine3[0] * v0))) * x45;
    const double x266 = ((x7 * x16) + (x17 * x48)) + (x50 * x260);
    const double x271 = x61 * ((x7 * x260) + (x58 * x266));
    const double x275 = (x56 * x266) + (x58 * x271);
    const double x277 = (x48 * x275) - x260;
    v[0] = v0;
    v[1] = v1;
    v[2] = v2;
    vdot[0] = x277;
    vdot[1] = x275;
    vdot[2] = -x271;
    if (lambda || power) {
        if (lambda) lambda[0] = -(x45 * (x17 - ((k[0] * x277) + (x7 * x271))));
        if (power) power[0] = 0.0;
    }
    if (pivots) {
        pivots[0] = -sine3[0];
        pivots[1] = 1.0;
        pivots[2] = x60 / (x59 + x60);
    }
    return ZD_DONE;
}

static const int solve_0[] = {0};
static const int row_0[] = {0};
static const int column_0[] = {1};
static const int solve_1[] = {0};
static const int row_1[] = {0};
static const int column_1[] = {0};

static const zd_elimination orders[] = {
    {1, solve_0, row_0, column_0, accelerate_0, correct_0, land_0},
    {1, solve_1, row_1, column_1, accelerate_1, correct_1, land_1},
};

const zd_direct zd_chaplygin_sleigh_direct = {ZD_BASELINE, 1, 2, orders};
