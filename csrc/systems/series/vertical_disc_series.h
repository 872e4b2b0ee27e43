/* Written by python/write_series.py with SymPy 1.14.0, from tests/symbolic_counterparts.py. */
/* Taylor coefficients of zd_vertical_disc, in the precision of the numbers that the including file has chosen. */
enum { ROWS = 16 };

ZD_SERIES_ON static int evaluate(const void *data, const double *inputs, int orders, zd_number t,
    const zd_number *restrict p, const zd_number *restrict v, zd_number *restrict P, zd_number *restrict V,
    zd_number *restrict E, zd_number *restrict scratch)
{
    const zd_number *restrict const k = ZD_SERIES_NUMBERS;
    zd_number *restrict const X = scratch, *restrict const Y = X + (orders + 1) * ROWS;
    zd_number L[36] = {ZD_NUM(0.0)}, right[6], x[6], first[6], sum[ROWS];
    double sizes[6];
    ZD_INVERSE(G, 36, L);
    (void)k, (void)inputs, (void)t, (void)sum, (void)first;
    const zd_number z0 = k[0];
    const zd_number z2 = k[3];
    const zd_number z3 = k[2];
    const zd_number z4 = ZD_NUM(1.0);
    const zd_number z5 = k[1];
    const zd_number z6 = p[2];
    const zd_number z13 = v[2];
    const zd_number z15 = v[3];
    const zd_number angle7[1] = {z6};
    zd_number sin7[1], cos7[1];
    ZD_TURNS(1, angle7, sin7, cos7);
    const zd_number z7 = sin7[0];
    const zd_number z8 = cos7[0];
    const zd_number z9 = ZD_MUL(z8, z5);
    const zd_number z10 = ZD_NEG(z9);
    const zd_number z11 = ZD_MUL(z5, z7);
    const zd_number z12 = ZD_NEG(z11);
    const zd_number z14 = ZD_MUL(z11, z13);
    const zd_number z16 = ZD_MUL(z15, z14);
    const zd_number z17 = ZD_NEG(z16);
    const zd_number z18 = ZD_MUL(z9, z13);
    const zd_number z19 = ZD_MUL(z15, z18);
    L[0] = z0;
    right[0] = ZD_SUB(ZD_NUM(0.0), ZD_NUM(0.0));
    L[7] = z0;
    right[1] = ZD_SUB(ZD_NUM(0.0), ZD_NUM(0.0));
    L[14] = z2;
    right[2] = ZD_SUB(ZD_NUM(0.0), ZD_NUM(0.0));
    L[21] = z3;
    right[3] = ZD_SUB(ZD_NUM(0.0), ZD_NUM(0.0));
    L[24] = L[4] = z4;
    L[27] = L[22] = z10;
    right[4] = z17;
    L[31] = L[11] = z4;
    L[33] = L[23] = z12;
    right[5] = z19;
    if (ZD_INVERT(4, 2, L, G, sizes)) return ZD_NOT_DEFINITE;
    ZD_SOLVE(6, L, G, right, x);
    for (int i = 0; i < 6; i++) first[i] = x[i];
    for (int i = 0; i < 4; i++) P[i] = p[i];
    for (int i = 0; i < 4; i++) V[i] = v[i];
    if (E) E[0] = ZD_NUM(0.0);
    {
        const int order = 0;
        const zd_number next = ZD_NUM(1.0);
        V[4] = x[0];
        V[5] = x[1];
        V[6] = x[2];
        V[7] = x[3];
        P[(order + 1) * 4 + 0] = ZD_MUL(next, V[order * 4 + 0]);
        P[(order + 1) * 4 + 1] = ZD_MUL(next, V[order * 4 + 1]);
        P[(order + 1) * 4 + 2] = ZD_MUL(next, V[order * 4 + 2]);
        P[(order + 1) * 4 + 3] = ZD_MUL(next, V[order * 4 + 3]);
    }
    for (int order = 1; order < orders; order++) {
        const zd_number share = ZD_DIV(ZD_NUM(1.0), ZD_NUM(order));
        const zd_number next = ZD_DIV(ZD_NUM(1.0), ZD_NUM(order + 1));
        (void)share;
        zd_series_sum(ROWS, order, X, Y, sum);
        const zd_number y6 = P[order * 4 + 2];
        const zd_number y7 = ZD_ADD(ZD_MUL(z8, y6), ZD_MUL(share, sum[0]));
        const zd_number y8 = ZD_NEG(ZD_ADD(ZD_MUL(z7, y6), ZD_MUL(share, sum[1])));
        const zd_number y9 = ZD_MUL(y8, z5);
        const zd_number y10 = ZD_NEG(y9);
        const zd_number y11 = ZD_MUL(z5, y7);
        const zd_number y12 = ZD_NEG(y11);
        const zd_number y13 = V[order * 4 + 2];
        const zd_number y14 = ZD_ADD(sum[2], ZD_ADD(ZD_MUL(z11, y13), ZD_MUL(y11, z13)));
        const zd_number y15 = V[order * 4 + 3];
        const zd_number y16 = ZD_ADD(sum[3], ZD_ADD(ZD_MUL(z15, y14), ZD_MUL(y15, z14)));
        const zd_number y17 = ZD_NEG(y16);
        const zd_number y18 = ZD_ADD(sum[4], ZD_ADD(ZD_MUL(z9, y13), ZD_MUL(y9, z13)));
        const zd_number y19 = ZD_ADD(sum[5], ZD_ADD(ZD_MUL(z15, y18), ZD_MUL(y15, z18)));
        right[0] = ZD_NUM(0.0);
        right[1] = ZD_NUM(0.0);
        right[2] = ZD_NUM(0.0);
        right[3] = ZD_SUB(ZD_SUB(ZD_NUM(0.0), ZD_ADD(sum[6], ZD_MUL(y10, first[4]))), ZD_ADD(sum[7], ZD_MUL(y12, first[5])));
        right[4] = ZD_SUB(y17, ZD_ADD(sum[8], ZD_MUL(y10, first[3])));
        right[5] = ZD_SUB(y19, ZD_ADD(sum[9], ZD_MUL(y12, first[3])));
        ZD_SOLVE(6, L, G, right, x);
        V[(order + 1) * 4 + 0] = ZD_MUL(next, x[0]);
        V[(order + 1) * 4 + 1] = ZD_MUL(next, x[1]);
        V[(order + 1) * 4 + 2] = ZD_MUL(next, x[2]);
        V[(order + 1) * 4 + 3] = ZD_MUL(next, x[3]);
        P[(order + 1) * 4 + 0] = ZD_MUL(next, V[order * 4 + 0]);
        P[(order + 1) * 4 + 1] = ZD_MUL(next, V[order * 4 + 1]);
        P[(order + 1) * 4 + 2] = ZD_MUL(next, V[order * 4 + 2]);
        P[(order + 1) * 4 + 3] = ZD_MUL(next, V[order * 4 + 3]);
        X[order * ROWS + 0] = ZD_MUL(ZD_NUM(order), y6);
        Y[order * ROWS + 0] = y8;
        X[order * ROWS + 1] = ZD_MUL(ZD_NUM(order), y6);
        Y[order * ROWS + 1] = y7;
        X[order * ROWS + 2] = y11;
        Y[order * ROWS + 2] = y13;
        X[order * ROWS + 3] = y14;
        Y[order * ROWS + 3] = y15;
        X[order * ROWS + 4] = y9;
        Y[order * ROWS + 4] = y13;
        X[order * ROWS + 5] = y15;
        Y[order * ROWS + 5] = y18;
        X[order * ROWS + 6] = y10;
        Y[order * ROWS + 6] = x[4];
        X[order * ROWS + 7] = y12;
        Y[order * ROWS + 7] = x[5];
        X[order * ROWS + 8] = x[3];
        Y[order * ROWS + 8] = y10;
        X[order * ROWS + 9] = x[3];
        Y[order * ROWS + 9] = y12;
    }
    return ZD_DONE;
}
