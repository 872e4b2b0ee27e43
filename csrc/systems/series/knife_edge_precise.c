#define ZD_SERIES_SIZE 4
#define ZD_SERIES_DOUBLE_DOUBLE
/* Written by python/write_series.py with SymPy 1.14.0, from tests/support/symbolic_counterparts.py. */
#include <math.h>
#include "../../include/zerodrift/series.h"
#include "../../include/zerodrift/system.h"
#include "series.h"

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
    const zd_number z2 = k[1];
    const zd_number z3 = k[2];
    const zd_number z4 = ZD_MUL(z0, z3);
    const zd_number z5 = k[3];
    const zd_number z8 = p[2];
    const zd_number z12 = v[2];
    const zd_number z13 = v[1];
    const zd_number z15 = v[0];
    const zd_number angle6[2] = {z5, z8};
    zd_number sin6[2], cos6[2];
    ZD_TURNS(2, angle6, sin6, cos6);
    const zd_number z6 = sin6[0];
    const zd_number z9 = sin6[1];
    const zd_number z10 = cos6[1];
    const zd_number z7 = ZD_MUL(z6, z4);
    const zd_number z11 = ZD_NEG(z10);
    const zd_number z14 = ZD_MUL(z9, z13);
    const zd_number z16 = ZD_MUL(z10, z15);
    const zd_number z17 = ZD_ADD(z16, z14);
    const zd_number z18 = ZD_MUL(z17, z12);
    const zd_number z19 = ZD_NEG(z18);
    L[0] = z0;
    right[0] = ZD_SUB(z7, ZD_NUM(0.0));
    L[5] = z0;
    right[1] = ZD_SUB(ZD_NUM(0.0), ZD_NUM(0.0));
    L[10] = z2;
    right[2] = ZD_SUB(ZD_NUM(0.0), ZD_NUM(0.0));
    L[12] = L[3] = z9;
    L[13] = L[7] = z11;
    right[3] = z19;
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
        const zd_number y8 = P[order * 3 + 2];
        const zd_number y9 = ZD_ADD(ZD_MUL(z10, y8), ZD_MUL(share, sum[0]));
        const zd_number y10 = ZD_NEG(ZD_ADD(ZD_MUL(z9, y8), ZD_MUL(share, sum[1])));
        const zd_number y11 = ZD_NEG(y10);
        const zd_number y12 = V[order * 3 + 2];
        const zd_number y13 = V[order * 3 + 1];
        const zd_number y14 = ZD_ADD(sum[2], ZD_ADD(ZD_MUL(z9, y13), ZD_MUL(y9, z13)));
        const zd_number y15 = V[order * 3 + 0];
        const zd_number y16 = ZD_ADD(sum[3], ZD_ADD(ZD_MUL(z10, y15), ZD_MUL(y10, z15)));
        const zd_number y17 = ZD_ADD(y16, y14);
        const zd_number y18 = ZD_ADD(sum[4], ZD_ADD(ZD_MUL(z17, y12), ZD_MUL(y17, z12)));
        const zd_number y19 = ZD_NEG(y18);
        right[0] = ZD_SUB(ZD_NUM(0.0), ZD_ADD(sum[5], ZD_MUL(y9, first[3])));
        right[1] = ZD_SUB(ZD_NUM(0.0), ZD_ADD(sum[6], ZD_MUL(y11, first[3])));
        right[2] = ZD_NUM(0.0);
        right[3] = ZD_SUB(ZD_SUB(y19, ZD_ADD(sum[7], ZD_MUL(y9, first[0]))), ZD_ADD(sum[8], ZD_MUL(y11, first[1])));
        ZD_SOLVE(4, L, G, right, x);
        V[(order + 1) * 3 + 0] = ZD_MUL(next, x[0]);
        V[(order + 1) * 3 + 1] = ZD_MUL(next, x[1]);
        V[(order + 1) * 3 + 2] = ZD_MUL(next, x[2]);
        P[(order + 1) * 3 + 0] = ZD_MUL(next, V[order * 3 + 0]);
        P[(order + 1) * 3 + 1] = ZD_MUL(next, V[order * 3 + 1]);
        P[(order + 1) * 3 + 2] = ZD_MUL(next, V[order * 3 + 2]);
        X[order * ROWS + 0] = ZD_MUL(ZD_NUM(order), y8);
        Y[order * ROWS + 0] = y10;
        X[order * ROWS + 1] = ZD_MUL(ZD_NUM(order), y8);
        Y[order * ROWS + 1] = y9;
        X[order * ROWS + 2] = y9;
        Y[order * ROWS + 2] = y13;
        X[order * ROWS + 3] = y10;
        Y[order * ROWS + 3] = y15;
        X[order * ROWS + 4] = y12;
        Y[order * ROWS + 4] = y17;
        X[order * ROWS + 5] = y9;
        Y[order * ROWS + 5] = x[3];
        X[order * ROWS + 6] = y11;
        Y[order * ROWS + 6] = x[3];
        X[order * ROWS + 7] = x[0];
        Y[order * ROWS + 7] = y9;
        X[order * ROWS + 8] = x[1];
        Y[order * ROWS + 8] = y11;
    }
    return ZD_DONE;
}

ZD_DD_RARE int residuals(const zd_number *restrict k, zd_number t, const zd_number *restrict p,
    const zd_number *restrict v, zd_number *restrict Phi, zd_number *restrict Psi, double *restrict M,
    double *restrict C, double *restrict A)
{
    (void)k, (void)t, (void)p, (void)v, (void)Phi, (void)Psi, (void)M, (void)C, (void)A;
    const zd_number z0 = k[0];
    const zd_number z2 = k[1];
    const zd_number z3 = p[2];
    const zd_number angle4[1] = {z3};
    zd_number sin4[1], cos4[1];
    ZD_TURNS(1, angle4, sin4, cos4);
    const zd_number z4 = sin4[0];
    const zd_number z5 = cos4[0];
    const zd_number z6 = ZD_NEG(z5);
    Psi[0] = ZD_ADD(ZD_ADD(ZD_NUM(0.0), ZD_MUL(z4, v[0])), ZD_MUL(z6, v[1]));
    M[0] = z0.high;
    M[4] = z0.high;
    M[8] = z2.high;
    C[0] = z4.high;
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
const zd_precise zd_knife_edge_precise = {2 * ROWS, precise_series, precise_residuals, zd_series_value};
