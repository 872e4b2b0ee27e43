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
    const zd_number z4 = p[2];
    const zd_number z8 = v[2];
    const zd_number z9 = v[1];
    const zd_number z11 = v[0];
    const zd_number angle5[1] = {z4};
    zd_number sin5[1], cos5[1];
    ZD_TURNS(1, angle5, sin5, cos5);
    const zd_number z5 = sin5[0];
    const zd_number z6 = cos5[0];
    const zd_number z7 = ZD_NEG(z6);
    const zd_number z10 = ZD_MUL(z5, z9);
    const zd_number z12 = ZD_MUL(z6, z11);
    const zd_number z13 = ZD_ADD(z12, z10);
    const zd_number z14 = ZD_MUL(z13, z8);
    const zd_number z15 = ZD_NEG(z14);
    L[0] = z0;
    right[0] = ZD_SUB(z3, ZD_NUM(0.0));
    L[5] = z0;
    right[1] = ZD_SUB(ZD_NUM(0.0), ZD_NUM(0.0));
    L[10] = z2;
    right[2] = ZD_SUB(ZD_NUM(0.0), ZD_NUM(0.0));
    L[12] = L[3] = z5;
    L[13] = L[7] = z7;
    right[3] = z15;
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
        const zd_number y7 = ZD_NEG(y6);
        const zd_number y8 = V[order * 3 + 2];
        const zd_number y9 = V[order * 3 + 1];
        const zd_number y10 = ZD_ADD(sum[2], ZD_ADD(ZD_MUL(z5, y9), ZD_MUL(y5, z9)));
        const zd_number y11 = V[order * 3 + 0];
        const zd_number y12 = ZD_ADD(sum[3], ZD_ADD(ZD_MUL(z6, y11), ZD_MUL(y6, z11)));
        const zd_number y13 = ZD_ADD(y12, y10);
        const zd_number y14 = ZD_ADD(sum[4], ZD_ADD(ZD_MUL(z13, y8), ZD_MUL(y13, z8)));
        const zd_number y15 = ZD_NEG(y14);
        right[0] = ZD_SUB(ZD_NUM(0.0), ZD_ADD(sum[5], ZD_MUL(y5, first[3])));
        right[1] = ZD_SUB(ZD_NUM(0.0), ZD_ADD(sum[6], ZD_MUL(y7, first[3])));
        right[2] = ZD_NUM(0.0);
        right[3] = ZD_SUB(ZD_SUB(y15, ZD_ADD(sum[7], ZD_MUL(y5, first[0]))), ZD_ADD(sum[8], ZD_MUL(y7, first[1])));
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
        X[order * ROWS + 2] = y5;
        Y[order * ROWS + 2] = y9;
        X[order * ROWS + 3] = y6;
        Y[order * ROWS + 3] = y11;
        X[order * ROWS + 4] = y8;
        Y[order * ROWS + 4] = y13;
        X[order * ROWS + 5] = y5;
        Y[order * ROWS + 5] = x[3];
        X[order * ROWS + 6] = y7;
        Y[order * ROWS + 6] = x[3];
        X[order * ROWS + 7] = x[0];
        Y[order * ROWS + 7] = y5;
        X[order * ROWS + 8] = x[1];
        Y[order * ROWS + 8] = y7;
    }
    return ZD_DONE;
}

const zd_series zd_knife_edge_series = {2 * ROWS, evaluate};
