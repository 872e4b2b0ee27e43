/* Written by python/write_series.py with SymPy 1.14.0, from tests/support/symbolic_counterparts.py. */
/* Taylor coefficients of zd_pendulum, in the precision of the numbers that the including file has chosen. */
enum { ROWS = 8 };

ZD_SERIES_ON static int evaluate(const void *data, const double *inputs, int orders, zd_number t,
    const zd_number *restrict p, const zd_number *restrict v, zd_number *restrict P, zd_number *restrict V,
    zd_number *restrict E, zd_number *restrict scratch)
{
    const zd_number *restrict const k = ZD_SERIES_NUMBERS;
    zd_number *restrict const X = scratch, *restrict const Y = X + (orders + 1) * ROWS;
    zd_number L[9] = {ZD_NUM(0.0)}, right[3], x[3], first[3], sum[ROWS];
    double sizes[3];
    ZD_INVERSE(G, 9, L);
    (void)k, (void)inputs, (void)t, (void)sum, (void)first;
    const zd_number z0 = k[1];
    const zd_number z2 = k[2];
    const zd_number z3 = ZD_MUL(z0, z2);
    const zd_number z4 = ZD_NEG(z3);
    const zd_number z5 = k[0];
    const zd_number z6 = ZD_NUM(1.0);
    const zd_number z7 = ZD_DIV(z6, z5);
    const zd_number z8 = p[0];
    const zd_number z9 = ZD_MUL(z8, z7);
    const zd_number z10 = p[1];
    const zd_number z11 = ZD_MUL(z10, z7);
    const zd_number z12 = ZD_NUM(2.0);
    const zd_number z13 = v[1];
    const zd_number z14 = ZD_MUL(z13, z13);
    const zd_number z15 = v[0];
    const zd_number z16 = ZD_MUL(z15, z15);
    const zd_number z17 = ZD_ADD(z16, z14);
    const zd_number z18 = ZD_MUL(z17, z12);
    const zd_number z19 = ZD_NUM(0.5);
    const zd_number z20 = ZD_MUL(z7, z19);
    const zd_number z21 = ZD_MUL(z20, z18);
    const zd_number z22 = ZD_NEG(z21);
    L[0] = z0;
    right[0] = ZD_SUB(ZD_NUM(0.0), ZD_NUM(0.0));
    L[4] = z0;
    right[1] = ZD_SUB(z4, ZD_NUM(0.0));
    L[6] = L[2] = z9;
    L[7] = L[5] = z11;
    right[2] = z22;
    if (ZD_INVERT(2, 1, L, G, sizes)) return ZD_NOT_DEFINITE;
    ZD_SOLVE(3, L, G, right, x);
    for (int i = 0; i < 3; i++) first[i] = x[i];
    for (int i = 0; i < 2; i++) P[i] = p[i];
    for (int i = 0; i < 2; i++) V[i] = v[i];
    if (E) E[0] = ZD_NUM(0.0);
    {
        const int order = 0;
        const zd_number next = ZD_NUM(1.0);
        V[2] = x[0];
        V[3] = x[1];
        P[(order + 1) * 2 + 0] = ZD_MUL(next, V[order * 2 + 0]);
        P[(order + 1) * 2 + 1] = ZD_MUL(next, V[order * 2 + 1]);
    }
    for (int order = 1; order < orders; order++) {
        const zd_number share = ZD_DIV(ZD_NUM(1.0), ZD_NUM(order));
        const zd_number next = ZD_DIV(ZD_NUM(1.0), ZD_NUM(order + 1));
        (void)share;
        zd_series_sum(ROWS, order, X, Y, sum);
        const zd_number y8 = P[order * 2 + 0];
        const zd_number y9 = ZD_MUL(y8, z7);
        const zd_number y10 = P[order * 2 + 1];
        const zd_number y11 = ZD_MUL(y10, z7);
        const zd_number y13 = V[order * 2 + 1];
        const zd_number y14 = ZD_ADD(sum[0], ZD_MUL(ZD_MUL(ZD_NUM(2), z13), y13));
        const zd_number y15 = V[order * 2 + 0];
        const zd_number y16 = ZD_ADD(sum[1], ZD_MUL(ZD_MUL(ZD_NUM(2), z15), y15));
        const zd_number y17 = ZD_ADD(y16, y14);
        const zd_number y18 = ZD_MUL(y17, z12);
        const zd_number y21 = ZD_MUL(z20, y18);
        const zd_number y22 = ZD_NEG(y21);
        right[0] = ZD_SUB(ZD_NUM(0.0), ZD_ADD(sum[2], ZD_MUL(y9, first[2])));
        right[1] = ZD_SUB(ZD_NUM(0.0), ZD_ADD(sum[3], ZD_MUL(y11, first[2])));
        right[2] = ZD_SUB(ZD_SUB(y22, ZD_ADD(sum[4], ZD_MUL(y9, first[0]))), ZD_ADD(sum[5], ZD_MUL(y11, first[1])));
        ZD_SOLVE(3, L, G, right, x);
        V[(order + 1) * 2 + 0] = ZD_MUL(next, x[0]);
        V[(order + 1) * 2 + 1] = ZD_MUL(next, x[1]);
        P[(order + 1) * 2 + 0] = ZD_MUL(next, V[order * 2 + 0]);
        P[(order + 1) * 2 + 1] = ZD_MUL(next, V[order * 2 + 1]);
        X[order * ROWS + 0] = y13;
        Y[order * ROWS + 0] = y13;
        X[order * ROWS + 1] = y15;
        Y[order * ROWS + 1] = y15;
        X[order * ROWS + 2] = y9;
        Y[order * ROWS + 2] = x[2];
        X[order * ROWS + 3] = y11;
        Y[order * ROWS + 3] = x[2];
        X[order * ROWS + 4] = x[0];
        Y[order * ROWS + 4] = y9;
        X[order * ROWS + 5] = x[1];
        Y[order * ROWS + 5] = y11;
    }
    return ZD_DONE;
}
