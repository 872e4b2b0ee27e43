/* Written by tests/direct_sources.py with SymPy 1.14.0, from tests/symbolic_counterparts.py. */
#include "slider_crank.h"

#include <math.h>
#include "../../include/zerodrift/sines.h"

/* What follows from the parameters alone, behind them. */
void zd_slider_crank_direct_constants(double *k)
{
    k[11] = 0.5 * k[5];
    k[12] = k[1] * k[8];
}

static int accelerate_0(const void *data, const double *restrict time, const double *restrict p,
    const double *restrict v, const double *restrict added, double *restrict pdot, double *restrict vdot,
    double *restrict lambda, double *restrict power, double *restrict pivots)
{
    const double *restrict const k = data;
    const double t = *time;
    (void)k, (void)t, (void)p, (void)v;
    (void)added, (void)pdot, (void)lambda, (void)power, (void)pivots;
    const double p0 = p[0], p1 = p[1], p2 = p[2];
    const double v0 = v[0], v1 = v[1], v2 = v[2];
    const double added0 = added ? added[0] : 0, added1 = added ? added[1] : 0;
    const double x94 = v0 * v0;
    const double x96 = v2 * v2;
    const double angle5[2] = {p0, p2};
    double sine5[2], cosine5[2];
    zd_sines(2, angle5, sine5, cosine5);
    const double x8 = sine5[0] * k[0];
    const double x12 = sine5[1] * k[1];
    const double x16 = -((x8 + x12) * 0.5);
    const double x19 = k[0] * cosine5[0];
    const double x21 = k[1] * cosine5[1];
    const double x22 = x19 + x21;
    const double x25 = p1 - (0.5 * x22);
    const double x27 = (x16 * x16) + (x25 * x25);
    const double x44 = 0.5 * ((x16 * (-((x19 * v0) + (x21 * v2)))) + (x25 * ((x12 * v2) + ((v1 * 2.0) + (x8 * v0)))));
    const double x48 = k[0] * ((sine5[0] * x25) - (x16 * cosine5[0]));
    const double x49 = 0.5 * x48;
    const double x54 = sqrt(x27);
    const double x56 = x54 - k[7];
    const double x70 = x56 * k[11];
    const double x74 = (k[8] - ((((p1 * 2.0) - x22) * x70) / x54)) - ((x44 * (x25 * k[6])) / x27);
    const double x78 = k[1] * ((sine5[1] * x25) - (x16 * cosine5[1]));
    const double x79 = 0.5 * x78;
    const double x88 = ((x44 * (k[6] * x79)) / x27) + (((x70 * x78) / x54) + (sine5[1] * k[12]));
    const double x119 = 1.0 / x21;
    const double x121 = x19 * x119;
    const double x125 = x8 - (x12 * x121);
    const double x127 = k[3] * x125;
    const double x129 = k[4] * x121;
    const double x143 = x119 * (added1 - ((x8 * x94) + (x12 * x96)));
    const double x147 = (added0 - ((x19 * x94) + (x21 * x96))) + (x12 * x143);
    const double x161 = ((x88 * x121) - ((((x44 * (x49 * k[6])) / x27) + ((x56 * (x48 * k[11])) / x54)) + (x74 * x125))) - ((x129 * x143) - (x127 * x147));
    const double x162 = (1.0 / ((x121 * x129) + (k[2] + (x125 * x127)))) * x161;
    const double x165 = x147 - (x125 * x162);
    const double x168 = x143 + (x121 * x162);
    vdot[0] = x162;
    vdot[1] = x165;
    vdot[2] = -x168;
    if (lambda || power) {
        const double x174 = x74 - (k[3] * x165);
        if (lambda) lambda[0] = x174;
        if (lambda) lambda[1] = -(x119 * (((k[4] * x168) - x88) - (x12 * x174)));
        if (power) power[0] = -(x44 * ((k[6] * ((v2 * x79) + ((v0 * x49) + (x25 * v1)))) / x27));
    }
    if (pivots) {
        pivots[0] = 1.0;
        pivots[1] = -x21;
        pivots[2] = 1.0;
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
    const double p0 = p[0], p1 = p[1], p2 = p[2];
    const double v0 = v[0], v1 = v[1], v2 = v[2];
    const double angle5[2] = {p0, p2};
    double sine5[2], cosine5[2];
    zd_sines(2, angle5, sine5, cosine5);
    const double x8 = sine5[0] * k[0];
    const double x12 = sine5[1] * k[1];
    const double x13 = x8 + x12;
    const double x19 = k[0] * cosine5[0];
    const double x21 = k[1] * cosine5[1];
    const double x90 = p1 - (x19 + x21);
    const double x119 = 1.0 / x21;
    const double x121 = x19 * x119;
    const double x125 = x8 - (x12 * x121);
    const double x127 = k[3] * x125;
    const double x129 = k[4] * x121;
    const double x137 = 1.0 / ((x121 * x129) + (k[2] + (x125 * x127)));
    const double x186 = x13 * x119;
    const double x189 = x90 - (x12 * x186);
    const double x196 = x137 * ((x127 * x189) + (x129 * x186));
    const double x203 = ((x19 * v0) + (x21 * v2)) * x119;
    const double x206 = ((x12 * v2) + (v1 + (x8 * v0))) - (x12 * x203);
    const double x213 = x137 * ((x127 * x206) + (x129 * x203));
    Phi[0] = x90;
    Phi[1] = -x13;
    dp[0] = x196;
    dp[1] = x189 - (x125 * x196);
    dp[2] = x186 - (x121 * x196);
    dv[0] = x213;
    dv[1] = x206 - (x125 * x213);
    dv[2] = x203 - (x121 * x213);
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
    const double p0 = p[0], p1 = p[1], p2 = p[2];
    const double before0 = v[0], before1 = v[1], before2 = v[2];
    const double angle5[2] = {p0, p2};
    double sine5[2], cosine5[2];
    zd_sines(2, angle5, sine5, cosine5);
    const double x8 = sine5[0] * k[0];
    const double x12 = sine5[1] * k[1];
    const double x13 = x8 + x12;
    const double x19 = k[0] * cosine5[0];
    const double x21 = k[1] * cosine5[1];
    const double x22 = x19 + x21;
    const double x90 = p1 - x22;
    Phi[0] = x90;
    Phi[1] = -x13;
    if (!(fabs(Phi[0]) <= allowed[0]) || !(fabs(Phi[1]) <= allowed[1])) {
        const double x119 = 1.0 / x21;
        const double x121 = x19 * x119;
        const double x125 = x8 - (x12 * x121);
        const double x127 = k[3] * x125;
        const double x129 = k[4] * x121;
        const double x137 = 1.0 / ((x121 * x129) + (k[2] + (x125 * x127)));
        const double x186 = x13 * x119;
        const double x189 = x90 - (x12 * x186);
        const double x196 = x137 * ((x127 * x189) + (x129 * x186));
        dp[0] = x196;
        dp[1] = x189 - (x125 * x196);
        dp[2] = x186 - (x121 * x196);
        return ZD_NO_CONVERGENCE;
    }
    const double x119 = 1.0 / x21;
    const double x121 = x19 * x119;
    const double x125 = x8 - (x12 * x121);
    const double x127 = k[3] * x125;
    const double x129 = k[4] * x121;
    const double x137 = 1.0 / ((x121 * x129) + (k[2] + (x125 * x127)));
    const double x233 = x119 * ((x19 * before0) + (x21 * before2));
    const double x236 = ((x12 * before2) + (before1 + (x8 * before0))) - (x12 * x233);
    const double x243 = x137 * ((x127 * x236) + (x129 * x233));
    const double v0 = before0 - x243;
    const double v1 = before1 - (x236 - (x125 * x243));
    const double v2 = before2 - (x233 - (x121 * x243));
    const double x16 = -(x13 * 0.5);
    const double x25 = p1 - (0.5 * x22);
    const double x27 = (x16 * x16) + (x25 * x25);
    const double x44 = 0.5 * ((x16 * (-((x19 * v0) + (x21 * v2)))) + (x25 * ((x12 * v2) + ((v1 * 2.0) + (x8 * v0)))));
    const double x48 = k[0] * ((sine5[0] * x25) - (x16 * cosine5[0]));
    const double x49 = 0.5 * x48;
    const double x54 = sqrt(x27);
    const double x56 = x54 - k[7];
    const double x70 = x56 * k[11];
    const double x74 = (k[8] - ((((p1 * 2.0) - x22) * x70) / x54)) - ((x44 * (x25 * k[6])) / x27);
    const double x78 = k[1] * ((sine5[1] * x25) - (x16 * cosine5[1]));
    const double x79 = 0.5 * x78;
    const double x88 = ((x44 * (k[6] * x79)) / x27) + (((x70 * x78) / x54) + (sine5[1] * k[12]));
    const double x94 = v0 * v0;
    const double x96 = v2 * v2;
    const double x250 = ((x8 * x94) + (x12 * x96)) * x119;
    const double x253 = ((x19 * x94) + (x21 * x96)) + (x12 * x250);
    const double x261 = ((x88 * x121) - ((((x44 * (x49 * k[6])) / x27) + ((x56 * (x48 * k[11])) / x54)) + (x74 * x125))) - ((x127 * x253) - (x129 * x250));
    const double x262 = x137 * x261;
    const double x265 = x253 + (x125 * x262);
    const double x269 = x250 - (x121 * x262);
    v[0] = v0;
    v[1] = v1;
    v[2] = v2;
    vdot[0] = x262;
    vdot[1] = -x265;
    vdot[2] = x269;
    if (lambda || power) {
        const double x275 = x74 + (k[3] * x265);
        if (lambda) lambda[0] = x275;
        if (lambda) lambda[1] = x119 * ((x88 + (k[4] * x269)) + (x12 * x275));
        if (power) power[0] = -(x44 * ((k[6] * ((v2 * x79) + ((v0 * x49) + (x25 * v1)))) / x27));
    }
    if (pivots) {
        pivots[0] = 1.0;
        pivots[1] = -x21;
        pivots[2] = 1.0;
    }
    return ZD_DONE;
}

static const int solve_0[] = {0, 1};
static const int row_0[] = {0, 1};
static const int column_0[] = {1, 2};

static const zd_elimination orders[] = {
    {2, solve_0, row_0, column_0, accelerate_0, correct_0, land_0},
};

const zd_direct zd_slider_crank_direct = {ZD_BASELINE, 1, 1, orders};
