/* Written by python/write_series.py with SymPy 1.14.0, from tests/support/symbolic_counterparts.py. */
/* Taylor coefficients of zd_oscillator, in the precision of the numbers that the including file has chosen. */
enum { ROWS = 8 };

ZD_SERIES_ON static int evaluate(const void *data, const double *inputs, int orders, zd_number t,
    const zd_number *restrict p, const zd_number *restrict v, zd_number *restrict P, zd_number *restrict V,
    zd_number *restrict E, zd_number *restrict scratch)
{
    const zd_number *restrict const k = ZD_SERIES_NUMBERS;
    zd_number *restrict const X = scratch, *restrict const Y = X + (orders + 1) * ROWS;
    zd_number L[1] = {ZD_NUM(0.0)}, right[1], x[1], first[1], sum[ROWS];
    double sizes[1];
    ZD_INVERSE(G, 1, L);
    (void)k, (void)inputs, (void)t, (void)sum, (void)first;
    const zd_number z0 = k[0];
    const zd_number z1 = k[1];
    const zd_number z2 = p[0];
    const zd_number z3 = ZD_MUL(z2, z1);
    const zd_number z4 = ZD_NEG(z3);
    L[0] = z0;
    right[0] = ZD_SUB(z4, ZD_NUM(0.0));
    if (ZD_INVERT(1, 0, L, G, sizes)) return ZD_NOT_DEFINITE;
    ZD_SOLVE(1, L, G, right, x);
    for (int i = 0; i < 1; i++) first[i] = x[i];
    for (int i = 0; i < 1; i++) P[i] = p[i];
    for (int i = 0; i < 1; i++) V[i] = v[i];
    if (E) E[0] = ZD_NUM(0.0);
    {
        const int order = 0;
        const zd_number next = ZD_NUM(1.0);
        V[1] = x[0];
        P[(order + 1) * 1 + 0] = ZD_MUL(next, V[order * 1 + 0]);
    }
    for (int order = 1; order < orders; order++) {
        const zd_number share = ZD_DIV(ZD_NUM(1.0), ZD_NUM(order));
        const zd_number next = ZD_DIV(ZD_NUM(1.0), ZD_NUM(order + 1));
        (void)share;
        zd_series_sum(ROWS, order, X, Y, sum);
        const zd_number y2 = P[order * 1 + 0];
        const zd_number y3 = ZD_MUL(y2, z1);
        const zd_number y4 = ZD_NEG(y3);
        right[0] = ZD_ADD(ZD_NUM(0.0), y4);
        ZD_SOLVE(1, L, G, right, x);
        V[(order + 1) * 1 + 0] = ZD_MUL(next, x[0]);
        P[(order + 1) * 1 + 0] = ZD_MUL(next, V[order * 1 + 0]);
    }
    return ZD_DONE;
}
