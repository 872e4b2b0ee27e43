#define ZD_SERIES_SIZE 4
#define ZD_SERIES_DOUBLE_DOUBLE
/* Written by python/write_series.py with SymPy 1.14.0, from tests/symbolic_counterparts.py. */
#include <math.h>
#include "../../include/zerodrift/series.h"
#include "../../include/zerodrift/system.h"
#include "precise.h"

enum { ROWS = 16 };

ZD_SERIES_ON static int evaluate(const void *data, const double *inputs, int orders, zd_number t,
    const zd_number *restrict p, const zd_number *restrict v, zd_number *restrict P, zd_number *restrict V,
    zd_number *restrict E, zd_number *restrict scratch)
{
    const zd_number *restrict const k = data;
    zd_number *restrict const X = scratch, *restrict const Y = X + (orders + 1) * ROWS;
    zd_number L[16] = {ZD_NUM(0.0)}, right[4], x[4], first[4], sum[ROWS];
    double sizes[4];
    ZD_INVERSE(G, 16, L);
    (void)k, (void)inputs, (void)t, (void)sum, (void)first;
    const zd_number z0 = k[0];
    const zd_number z2 = k[2];
    const zd_number z3 = ZD_MUL(z0, z2);
    const zd_number z4 = p[2];
    const zd_number z10 = ZD_MUL(z2, z2);
    const zd_number z11 = ZD_MUL(z0, z10);
    const zd_number z12 = k[1];
    const zd_number z13 = ZD_ADD(z12, z11);
    const zd_number z14 = v[2];
    const zd_number z15 = ZD_MUL(z14, z14);
    const zd_number z21 = v[0];
    const zd_number z23 = v[1];
    const zd_number angle5[1] = {z4};
    zd_number sin5[1], cos5[1];
    ZD_TURNS(1, angle5, sin5, cos5);
    const zd_number z5 = sin5[0];
    const zd_number z6 = cos5[0];
    const zd_number z7 = ZD_MUL(z5, z3);
    const zd_number z8 = ZD_NEG(z7);
    const zd_number z9 = ZD_MUL(z3, z6);
    const zd_number z16 = ZD_MUL(z9, z15);
    const zd_number z17 = ZD_NEG(z16);
    const zd_number z18 = ZD_MUL(z7, z15);
    const zd_number z19 = ZD_NEG(z18);
    const zd_number z20 = ZD_NEG(z5);
    const zd_number z22 = ZD_MUL(z6, z21);
    const zd_number z24 = ZD_MUL(z5, z23);
    const zd_number z25 = ZD_ADD(z24, z22);
    const zd_number z26 = ZD_MUL(z14, z25);
    L[0] = z0;
    L[2] = z8;
    right[0] = ZD_SUB(ZD_NUM(0.0), z17);
    L[5] = z0;
    L[6] = z9;
    right[1] = ZD_SUB(ZD_NUM(0.0), z19);
    L[8] = z8;
    L[9] = z9;
    L[10] = z13;
    right[2] = ZD_SUB(ZD_NUM(0.0), ZD_NUM(0.0));
    L[12] = L[3] = z20;
    L[13] = L[7] = z6;
    right[3] = z26;
    if (ZD_INVERT(3, 1, L, G, sizes)) return ZD_NOT_DEFINITE;
    ZD_SOLVE(4, L, G, right, x);
    for (int i = 0; i < 4; i++) first[i] = x[i];
    for (int i = 0; i < 3; i++) P[i] = p[i];
    for (int i = 0; i < 3; i++) V[i] = v[i];
    if (E) E[0] = ZD_NUM(0.0);
    {
        const int order = 0;
        const zd_number next = ZD_NUM(1.0);
        V[3] = x[0];
        V[4] = x[1];
        V[5] = x[2];
        P[(order + 1) * 3 + 0] = ZD_MUL(next, V[order * 3 + 0]);
        P[(order + 1) * 3 + 1] = ZD_MUL(next, V[order * 3 + 1]);
        P[(order + 1) * 3 + 2] = ZD_MUL(next, V[order * 3 + 2]);
    }
    for (int order = 1; order < orders; order++) {
        const zd_number share = ZD_DIV(ZD_NUM(1.0), ZD_NUM(order));
        const zd_number next = ZD_DIV(ZD_NUM(1.0), ZD_NUM(order + 1));
        (void)share;
        zd_series_sum(ROWS, order, X, Y, sum);
        const zd_number y4 = P[order * 3 + 2];
        const zd_number y5 = ZD_ADD(ZD_MUL(z6, y4), ZD_MUL(share, sum[0]));
        const zd_number y6 = ZD_NEG(ZD_ADD(ZD_MUL(z5, y4), ZD_MUL(share, sum[1])));
        const zd_number y7 = ZD_MUL(y5, z3);
        const zd_number y8 = ZD_NEG(y7);
        const zd_number y9 = ZD_MUL(z3, y6);
        const zd_number y14 = V[order * 3 + 2];
        const zd_number y15 = ZD_ADD(sum[2], ZD_MUL(ZD_MUL(ZD_NUM(2), z14), y14));
        const zd_number y16 = ZD_ADD(sum[3], ZD_ADD(ZD_MUL(z9, y15), ZD_MUL(y9, z15)));
        const zd_number y17 = ZD_NEG(y16);
        const zd_number y18 = ZD_ADD(sum[4], ZD_ADD(ZD_MUL(z7, y15), ZD_MUL(y7, z15)));
        const zd_number y19 = ZD_NEG(y18);
        const zd_number y20 = ZD_NEG(y5);
        const zd_number y21 = V[order * 3 + 0];
        const zd_number y22 = ZD_ADD(sum[5], ZD_ADD(ZD_MUL(z6, y21), ZD_MUL(y6, z21)));
        const zd_number y23 = V[order * 3 + 1];
        const zd_number y24 = ZD_ADD(sum[6], ZD_ADD(ZD_MUL(z5, y23), ZD_MUL(y5, z23)));
        const zd_number y25 = ZD_ADD(y24, y22);
        const zd_number y26 = ZD_ADD(sum[7], ZD_ADD(ZD_MUL(z14, y25), ZD_MUL(y14, z25)));
        right[0] = ZD_SUB(ZD_SUB(ZD_SUB(ZD_NUM(0.0), y17), ZD_ADD(sum[8], ZD_MUL(y8, first[2]))), ZD_ADD(sum[9], ZD_MUL(y20, first[3])));
        right[1] = ZD_SUB(ZD_SUB(ZD_SUB(ZD_NUM(0.0), y19), ZD_ADD(sum[10], ZD_MUL(y9, first[2]))), ZD_ADD(sum[11], ZD_MUL(y6, first[3])));
        right[2] = ZD_SUB(ZD_SUB(ZD_NUM(0.0), ZD_ADD(sum[12], ZD_MUL(y8, first[0]))), ZD_ADD(sum[13], ZD_MUL(y9, first[1])));
        right[3] = ZD_SUB(ZD_SUB(y26, ZD_ADD(sum[14], ZD_MUL(y20, first[0]))), ZD_ADD(sum[15], ZD_MUL(y6, first[1])));
        ZD_SOLVE(4, L, G, right, x);
        V[(order + 1) * 3 + 0] = ZD_MUL(next, x[0]);
        V[(order + 1) * 3 + 1] = ZD_MUL(next, x[1]);
        V[(order + 1) * 3 + 2] = ZD_MUL(next, x[2]);
        P[(order + 1) * 3 + 0] = ZD_MUL(next, V[order * 3 + 0]);
        P[(order + 1) * 3 + 1] = ZD_MUL(next, V[order * 3 + 1]);
        P[(order + 1) * 3 + 2] = ZD_MUL(next, V[order * 3 + 2]);
        X[order * ROWS + 0] = ZD_MUL(ZD_NUM(order), y4);
        Y[order * ROWS + 0] = y6;
        X[order * ROWS + 1] = ZD_MUL(ZD_NUM(order), y4);
        Y[order * ROWS + 1] = y5;
        X[order * ROWS + 2] = y14;
        Y[order * ROWS + 2] = y14;
        X[order * ROWS + 3] = y9;
        Y[order * ROWS + 3] = y15;
        X[order * ROWS + 4] = y7;
        Y[order * ROWS + 4] = y15;
        X[order * ROWS + 5] = y6;
        Y[order * ROWS + 5] = y21;
        X[order * ROWS + 6] = y5;
        Y[order * ROWS + 6] = y23;
        X[order * ROWS + 7] = y14;
        Y[order * ROWS + 7] = y25;
        X[order * ROWS + 8] = x[2];
        Y[order * ROWS + 8] = y8;
        X[order * ROWS + 9] = y20;
        Y[order * ROWS + 9] = x[3];
        X[order * ROWS + 10] = x[2];
        Y[order * ROWS + 10] = y9;
        X[order * ROWS + 11] = y6;
        Y[order * ROWS + 11] = x[3];
        X[order * ROWS + 12] = x[0];
        Y[order * ROWS + 12] = y8;
        X[order * ROWS + 13] = x[1];
        Y[order * ROWS + 13] = y9;
        X[order * ROWS + 14] = x[0];
        Y[order * ROWS + 14] = y20;
        X[order * ROWS + 15] = x[1];
        Y[order * ROWS + 15] = y6;
    }
    return ZD_DONE;
}

ZD_DD_RARE int residuals(const zd_number *restrict k, zd_number t, const zd_number *restrict p,
    const zd_number *restrict v, zd_number *restrict Phi, zd_number *restrict Psi, double *restrict M,
    double *restrict C, double *restrict A)
{
    (void)k, (void)t, (void)p, (void)v, (void)Phi, (void)Psi, (void)M, (void)C, (void)A;
    const zd_number z0 = k[0];
    const zd_number z2 = k[2];
    const zd_number z3 = ZD_MUL(z0, z2);
    const zd_number z4 = p[2];
    const zd_number z10 = ZD_MUL(z2, z2);
    const zd_number z11 = ZD_MUL(z0, z10);
    const zd_number z12 = k[1];
    const zd_number z13 = ZD_ADD(z12, z11);
    const zd_number angle5[1] = {z4};
    zd_number sin5[1], cos5[1];
    ZD_TURNS(1, angle5, sin5, cos5);
    const zd_number z5 = sin5[0];
    const zd_number z6 = cos5[0];
    const zd_number z7 = ZD_MUL(z5, z3);
    const zd_number z8 = ZD_NEG(z7);
    const zd_number z9 = ZD_MUL(z3, z6);
    const zd_number z14 = ZD_NEG(z5);
    Psi[0] = ZD_ADD(ZD_ADD(ZD_NUM(0.0), ZD_MUL(z14, v[0])), ZD_MUL(z6, v[1]));
    M[0] = z0.high;
    M[2] = z8.high;
    M[4] = z0.high;
    M[5] = z9.high;
    M[6] = z8.high;
    M[7] = z9.high;
    M[8] = z13.high;
    C[0] = z14.high;
    C[1] = z6.high;
    return ZD_DONE;
}

static int precise_series(const double *numbers, int order, const double *t, const double *p, const double *v, double *p_series,
                          double *v_series, double *scratch)
{
    return evaluate(numbers, (const double *)0, order, *(const zd_number *)t, (const zd_number *)p, (const zd_number *)v,
                    (zd_number *)p_series, (zd_number *)v_series, (zd_number *)0, (zd_number *)scratch);
}

static int precise_residuals(const double *numbers, const double *t, const double *p, const double *v, double *Phi, double *Psi,
                             double *M, double *C, double *A)
{
    return residuals((const zd_number *)numbers, *(const zd_number *)t, (const zd_number *)p, (const zd_number *)v,
                     (zd_number *)Phi, (zd_number *)Psi, M, C, A);
}
const zd_precise zd_chaplygin_sleigh_precise = {2 * ROWS, precise_series, precise_residuals, zd_series_value};
