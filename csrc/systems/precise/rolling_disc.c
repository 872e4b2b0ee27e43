#define ZD_SERIES_SIZE 9
#define ZD_SERIES_DOUBLE_DOUBLE
/* Written by python/write_series.py with SymPy 1.14.0, from tests/symbolic_counterparts.py. */
#include <math.h>
#include "../../include/zerodrift/series.h"
#include "../../include/zerodrift/system.h"
#include "precise.h"

enum { ROWS = 40 };

ZD_SERIES_ON static int evaluate(const void *data, const double *inputs, int orders, zd_number t,
    const zd_number *restrict p, const zd_number *restrict v, zd_number *restrict P, zd_number *restrict V,
    zd_number *restrict E, zd_number *restrict scratch)
{
    const zd_number *restrict const k = data;
    zd_number *restrict const X = scratch, *restrict const Y = X + (orders + 1) * ROWS;
    zd_number L[81] = {ZD_NUM(0.0)}, right[9], x[9], first[9], sum[ROWS];
    double sizes[9];
    ZD_INVERSE(G, 81, L);
    (void)k, (void)inputs, (void)t, (void)sum, (void)first;
    const zd_number z0 = ZD_NUM(1.0);
    const zd_number z2 = p[4];
    const zd_number z7 = k[0];
    const zd_number z8 = k[3];
    const zd_number z9 = k[4];
    const zd_number z10 = ZD_CALL(tan)(z2);
    const zd_number z11 = ZD_MUL(z10, z10);
    const zd_number z12 = ZD_ADD(z0, z11);
    const zd_number z13 = ZD_MUL(z9, z10);
    const zd_number z14 = v[5];
    const zd_number z15 = ZD_MUL(z14, z13);
    const zd_number z16 = v[3];
    const zd_number z17 = ZD_MUL(z8, z16);
    const zd_number z18 = ZD_ADD(z17, z15);
    const zd_number z19 = ZD_MUL(z14, z18);
    const zd_number z20 = v[4];
    const zd_number z21 = ZD_MUL(z18, z20);
    const zd_number z22 = ZD_NEG(z21);
    const zd_number z23 = k[2];
    const zd_number z24 = ZD_NEG(z23);
    const zd_number z25 = k[1];
    const zd_number z27 = p[3];
    const zd_number z38 = ZD_MUL(z20, z20);
    const zd_number angle3[2] = {z2, z27};
    zd_number sin3[2], cos3[2];
    ZD_TURNS(2, angle3, sin3, cos3);
    const zd_number z3 = sin3[0];
    const zd_number z4 = cos3[0];
    const zd_number z28 = sin3[1];
    const zd_number z29 = cos3[1];
    const zd_number z5 = ZD_DIV(z0, z4);
    const zd_number z6 = ZD_DIV(z3, z4);
    const zd_number z26 = ZD_MUL(z3, z25);
    const zd_number z30 = ZD_MUL(z25, z28);
    const zd_number z31 = ZD_NEG(z30);
    const zd_number z32 = ZD_MUL(z4, z25);
    const zd_number z33 = ZD_MUL(z32, z29);
    const zd_number z34 = ZD_NEG(z33);
    const zd_number z35 = ZD_MUL(z25, z29);
    const zd_number z36 = ZD_MUL(z32, z28);
    const zd_number z37 = ZD_NEG(z36);
    const zd_number z39 = ZD_MUL(z32, z38);
    const zd_number z40 = ZD_NEG(z39);
    const zd_number z41 = ZD_MUL(z14, z28);
    const zd_number z42 = ZD_MUL(z3, z29);
    const zd_number z43 = ZD_MUL(z20, z42);
    const zd_number z44 = ZD_ADD(z43, z41);
    const zd_number z45 = ZD_MUL(z20, z44);
    const zd_number z46 = ZD_MUL(z14, z29);
    const zd_number z47 = ZD_MUL(z16, z46);
    const zd_number z48 = ZD_DIV(z47, z4);
    const zd_number z49 = ZD_SUB(z48, z45);
    const zd_number z50 = ZD_MUL(z25, z49);
    const zd_number z51 = ZD_MUL(z16, z41);
    const zd_number z52 = ZD_DIV(z51, z4);
    const zd_number z53 = ZD_MUL(z3, z28);
    const zd_number z54 = ZD_MUL(z20, z53);
    const zd_number z55 = ZD_SUB(z54, z46);
    const zd_number z56 = ZD_MUL(z20, z55);
    const zd_number z57 = ZD_SUB(z56, z52);
    const zd_number z58 = ZD_MUL(z25, z57);
    const zd_number z59 = ZD_NEG(z58);
    L[0] = z7;
    right[0] = ZD_SUB(ZD_NUM(0.0), ZD_NUM(0.0));
    L[10] = z7;
    right[1] = ZD_SUB(ZD_NUM(0.0), ZD_NUM(0.0));
    L[20] = z7;
    right[2] = ZD_SUB(z24, ZD_NUM(0.0));
    L[30] = z8;
    right[3] = ZD_SUB(ZD_NUM(0.0), ZD_NUM(0.0));
    L[40] = z9;
    right[4] = ZD_SUB(ZD_NUM(0.0), z19);
    L[50] = z9;
    right[5] = ZD_SUB(ZD_NUM(0.0), z22);
    L[56] = L[24] = z0;
    L[58] = L[42] = z26;
    right[6] = z40;
    L[63] = L[7] = z0;
    L[66] = L[34] = z31;
    L[67] = L[43] = z34;
    right[7] = z50;
    L[73] = L[17] = z0;
    L[75] = L[35] = z35;
    L[76] = L[44] = z37;
    right[8] = z59;
    if (ZD_INVERT(6, 3, L, G, sizes)) return ZD_NOT_DEFINITE;
    ZD_SOLVE(9, L, G, right, x);
    for (int i = 0; i < 9; i++) first[i] = x[i];
    for (int i = 0; i < 6; i++) P[i] = p[i];
    for (int i = 0; i < 6; i++) V[i] = v[i];
    if (E) E[0] = ZD_NUM(0.0);
    {
        const int order = 0;
        const zd_number next = ZD_NUM(1.0);
        V[6] = x[0];
        V[7] = x[1];
        V[8] = x[2];
        V[9] = x[3];
        V[10] = x[4];
        V[11] = x[5];
        P[(order + 1) * 6 + 0] = ZD_MUL(next, ZD_MUL(z0, V[order * 6 + 0]));
        P[(order + 1) * 6 + 1] = ZD_MUL(next, ZD_MUL(z0, V[order * 6 + 1]));
        P[(order + 1) * 6 + 2] = ZD_MUL(next, ZD_MUL(z0, V[order * 6 + 2]));
        P[(order + 1) * 6 + 3] = ZD_MUL(next, ZD_MUL(z5, V[order * 6 + 5]));
        P[(order + 1) * 6 + 4] = ZD_MUL(next, ZD_MUL(z0, V[order * 6 + 4]));
        P[(order + 1) * 6 + 5] = ZD_MUL(next, ZD_ADD(ZD_MUL(z0, V[order * 6 + 3]), ZD_MUL(z6, V[order * 6 + 5])));
    }
    for (int order = 1; order < orders; order++) {
        const zd_number share = ZD_DIV(ZD_NUM(1.0), ZD_NUM(order));
        const zd_number next = ZD_DIV(ZD_NUM(1.0), ZD_NUM(order + 1));
        (void)share;
        zd_series_sum(ROWS, order, X, Y, sum);
        const zd_number y2 = P[order * 6 + 4];
        const zd_number y3 = ZD_ADD(ZD_MUL(z4, y2), ZD_MUL(share, sum[0]));
        const zd_number y4 = ZD_NEG(ZD_ADD(ZD_MUL(z3, y2), ZD_MUL(share, sum[1])));
        const zd_number y5 = ZD_DIV(ZD_NEG(ZD_ADD(sum[2], ZD_MUL(z5, y4))), z4);
        const zd_number y6 = ZD_DIV(ZD_SUB(y3, ZD_ADD(sum[3], ZD_MUL(z6, y4))), z4);
        const zd_number y10 = ZD_ADD(ZD_MUL(z12, y2), ZD_MUL(share, sum[4]));
        const zd_number y11 = ZD_ADD(sum[5], ZD_MUL(ZD_MUL(ZD_NUM(2), z10), y10));
        const zd_number y12 = y11;
        const zd_number y13 = ZD_MUL(z9, y10);
        const zd_number y14 = V[order * 6 + 5];
        const zd_number y15 = ZD_ADD(sum[6], ZD_ADD(ZD_MUL(z14, y13), ZD_MUL(y14, z13)));
        const zd_number y16 = V[order * 6 + 3];
        const zd_number y17 = ZD_MUL(z8, y16);
        const zd_number y18 = ZD_ADD(y17, y15);
        const zd_number y19 = ZD_ADD(sum[7], ZD_ADD(ZD_MUL(z14, y18), ZD_MUL(y14, z18)));
        const zd_number y20 = V[order * 6 + 4];
        const zd_number y21 = ZD_ADD(sum[8], ZD_ADD(ZD_MUL(z18, y20), ZD_MUL(y18, z20)));
        const zd_number y22 = ZD_NEG(y21);
        const zd_number y26 = ZD_MUL(y3, z25);
        const zd_number y27 = P[order * 6 + 3];
        const zd_number y28 = ZD_ADD(ZD_MUL(z29, y27), ZD_MUL(share, sum[9]));
        const zd_number y29 = ZD_NEG(ZD_ADD(ZD_MUL(z28, y27), ZD_MUL(share, sum[10])));
        const zd_number y30 = ZD_MUL(z25, y28);
        const zd_number y31 = ZD_NEG(y30);
        const zd_number y32 = ZD_MUL(y4, z25);
        const zd_number y33 = ZD_ADD(sum[11], ZD_ADD(ZD_MUL(z32, y29), ZD_MUL(y32, z29)));
        const zd_number y34 = ZD_NEG(y33);
        const zd_number y35 = ZD_MUL(z25, y29);
        const zd_number y36 = ZD_ADD(sum[12], ZD_ADD(ZD_MUL(z32, y28), ZD_MUL(y32, z28)));
        const zd_number y37 = ZD_NEG(y36);
        const zd_number y38 = ZD_ADD(sum[13], ZD_MUL(ZD_MUL(ZD_NUM(2), z20), y20));
        const zd_number y39 = ZD_ADD(sum[14], ZD_ADD(ZD_MUL(z32, y38), ZD_MUL(y32, z38)));
        const zd_number y40 = ZD_NEG(y39);
        const zd_number y41 = ZD_ADD(sum[15], ZD_ADD(ZD_MUL(z14, y28), ZD_MUL(y14, z28)));
        const zd_number y42 = ZD_ADD(sum[16], ZD_ADD(ZD_MUL(z3, y29), ZD_MUL(y3, z29)));
        const zd_number y43 = ZD_ADD(sum[17], ZD_ADD(ZD_MUL(z20, y42), ZD_MUL(y20, z42)));
        const zd_number y44 = ZD_ADD(y43, y41);
        const zd_number y45 = ZD_ADD(sum[18], ZD_ADD(ZD_MUL(z20, y44), ZD_MUL(y20, z44)));
        const zd_number y46 = ZD_ADD(sum[19], ZD_ADD(ZD_MUL(z14, y29), ZD_MUL(y14, z29)));
        const zd_number y47 = ZD_ADD(sum[20], ZD_ADD(ZD_MUL(z16, y46), ZD_MUL(y16, z46)));
        const zd_number y48 = ZD_DIV(ZD_SUB(y47, ZD_ADD(sum[21], ZD_MUL(z48, y4))), z4);
        const zd_number y49 = ZD_SUB(y48, y45);
        const zd_number y50 = ZD_MUL(z25, y49);
        const zd_number y51 = ZD_ADD(sum[22], ZD_ADD(ZD_MUL(z16, y41), ZD_MUL(y16, z41)));
        const zd_number y52 = ZD_DIV(ZD_SUB(y51, ZD_ADD(sum[23], ZD_MUL(z52, y4))), z4);
        const zd_number y53 = ZD_ADD(sum[24], ZD_ADD(ZD_MUL(z3, y28), ZD_MUL(y3, z28)));
        const zd_number y54 = ZD_ADD(sum[25], ZD_ADD(ZD_MUL(z20, y53), ZD_MUL(y20, z53)));
        const zd_number y55 = ZD_SUB(y54, y46);
        const zd_number y56 = ZD_ADD(sum[26], ZD_ADD(ZD_MUL(z20, y55), ZD_MUL(y20, z55)));
        const zd_number y57 = ZD_SUB(y56, y52);
        const zd_number y58 = ZD_MUL(z25, y57);
        const zd_number y59 = ZD_NEG(y58);
        right[0] = ZD_NUM(0.0);
        right[1] = ZD_NUM(0.0);
        right[2] = ZD_NUM(0.0);
        right[3] = ZD_SUB(ZD_SUB(ZD_NUM(0.0), ZD_ADD(sum[27], ZD_MUL(y31, first[7]))), ZD_ADD(sum[28], ZD_MUL(y35, first[8])));
        right[4] = ZD_SUB(ZD_SUB(ZD_SUB(ZD_SUB(ZD_NUM(0.0), y19), ZD_ADD(sum[29], ZD_MUL(y26, first[6]))), ZD_ADD(sum[30], ZD_MUL(y34, first[7]))), ZD_ADD(sum[31], ZD_MUL(y37, first[8])));
        right[5] = ZD_SUB(ZD_NUM(0.0), y22);
        right[6] = ZD_SUB(y40, ZD_ADD(sum[32], ZD_MUL(y26, first[4])));
        right[7] = ZD_SUB(ZD_SUB(y50, ZD_ADD(sum[33], ZD_MUL(y31, first[3]))), ZD_ADD(sum[34], ZD_MUL(y34, first[4])));
        right[8] = ZD_SUB(ZD_SUB(y59, ZD_ADD(sum[35], ZD_MUL(y35, first[3]))), ZD_ADD(sum[36], ZD_MUL(y37, first[4])));
        ZD_SOLVE(9, L, G, right, x);
        V[(order + 1) * 6 + 0] = ZD_MUL(next, x[0]);
        V[(order + 1) * 6 + 1] = ZD_MUL(next, x[1]);
        V[(order + 1) * 6 + 2] = ZD_MUL(next, x[2]);
        V[(order + 1) * 6 + 3] = ZD_MUL(next, x[3]);
        V[(order + 1) * 6 + 4] = ZD_MUL(next, x[4]);
        V[(order + 1) * 6 + 5] = ZD_MUL(next, x[5]);
        P[(order + 1) * 6 + 0] = ZD_MUL(next, ZD_MUL(z0, V[order * 6 + 0]));
        P[(order + 1) * 6 + 1] = ZD_MUL(next, ZD_MUL(z0, V[order * 6 + 1]));
        P[(order + 1) * 6 + 2] = ZD_MUL(next, ZD_MUL(z0, V[order * 6 + 2]));
        P[(order + 1) * 6 + 3] = ZD_MUL(next, ZD_ADD(ZD_ADD(ZD_MUL(z5, V[order * 6 + 5]), sum[37]), ZD_MUL(y5, v[5])));
        P[(order + 1) * 6 + 4] = ZD_MUL(next, ZD_MUL(z0, V[order * 6 + 4]));
        P[(order + 1) * 6 + 5] = ZD_MUL(next, ZD_ADD(ZD_ADD(ZD_ADD(ZD_MUL(z0, V[order * 6 + 3]), ZD_MUL(z6, V[order * 6 + 5])), sum[38]), ZD_MUL(y6, v[5])));
        X[order * ROWS + 0] = ZD_MUL(ZD_NUM(order), y2);
        Y[order * ROWS + 0] = y4;
        X[order * ROWS + 1] = ZD_MUL(ZD_NUM(order), y2);
        Y[order * ROWS + 1] = y3;
        X[order * ROWS + 2] = y4;
        Y[order * ROWS + 2] = y5;
        X[order * ROWS + 3] = y4;
        Y[order * ROWS + 3] = y6;
        X[order * ROWS + 4] = ZD_MUL(ZD_NUM(order), y2);
        Y[order * ROWS + 4] = y12;
        X[order * ROWS + 5] = y10;
        Y[order * ROWS + 5] = y10;
        X[order * ROWS + 6] = y13;
        Y[order * ROWS + 6] = y14;
        X[order * ROWS + 7] = y14;
        Y[order * ROWS + 7] = y18;
        X[order * ROWS + 8] = y18;
        Y[order * ROWS + 8] = y20;
        X[order * ROWS + 9] = ZD_MUL(ZD_NUM(order), y27);
        Y[order * ROWS + 9] = y29;
        X[order * ROWS + 10] = ZD_MUL(ZD_NUM(order), y27);
        Y[order * ROWS + 10] = y28;
        X[order * ROWS + 11] = y29;
        Y[order * ROWS + 11] = y32;
        X[order * ROWS + 12] = y28;
        Y[order * ROWS + 12] = y32;
        X[order * ROWS + 13] = y20;
        Y[order * ROWS + 13] = y20;
        X[order * ROWS + 14] = y32;
        Y[order * ROWS + 14] = y38;
        X[order * ROWS + 15] = y14;
        Y[order * ROWS + 15] = y28;
        X[order * ROWS + 16] = y3;
        Y[order * ROWS + 16] = y29;
        X[order * ROWS + 17] = y20;
        Y[order * ROWS + 17] = y42;
        X[order * ROWS + 18] = y20;
        Y[order * ROWS + 18] = y44;
        X[order * ROWS + 19] = y14;
        Y[order * ROWS + 19] = y29;
        X[order * ROWS + 20] = y16;
        Y[order * ROWS + 20] = y46;
        X[order * ROWS + 21] = y4;
        Y[order * ROWS + 21] = y48;
        X[order * ROWS + 22] = y16;
        Y[order * ROWS + 22] = y41;
        X[order * ROWS + 23] = y4;
        Y[order * ROWS + 23] = y52;
        X[order * ROWS + 24] = y3;
        Y[order * ROWS + 24] = y28;
        X[order * ROWS + 25] = y20;
        Y[order * ROWS + 25] = y53;
        X[order * ROWS + 26] = y20;
        Y[order * ROWS + 26] = y55;
        X[order * ROWS + 27] = y31;
        Y[order * ROWS + 27] = x[7];
        X[order * ROWS + 28] = y35;
        Y[order * ROWS + 28] = x[8];
        X[order * ROWS + 29] = y26;
        Y[order * ROWS + 29] = x[6];
        X[order * ROWS + 30] = y34;
        Y[order * ROWS + 30] = x[7];
        X[order * ROWS + 31] = y37;
        Y[order * ROWS + 31] = x[8];
        X[order * ROWS + 32] = x[4];
        Y[order * ROWS + 32] = y26;
        X[order * ROWS + 33] = x[3];
        Y[order * ROWS + 33] = y31;
        X[order * ROWS + 34] = x[4];
        Y[order * ROWS + 34] = y34;
        X[order * ROWS + 35] = x[3];
        Y[order * ROWS + 35] = y35;
        X[order * ROWS + 36] = x[4];
        Y[order * ROWS + 36] = y37;
        X[order * ROWS + 37] = y5;
        Y[order * ROWS + 37] = V[order * 6 + 5];
        X[order * ROWS + 38] = y6;
        Y[order * ROWS + 38] = V[order * 6 + 5];
    }
    return ZD_DONE;
}

ZD_DD_RARE int residuals(const zd_number *restrict k, zd_number t, const zd_number *restrict p,
    const zd_number *restrict v, zd_number *restrict Phi, zd_number *restrict Psi, double *restrict M,
    double *restrict C, double *restrict A)
{
    (void)k, (void)t, (void)p, (void)v, (void)Phi, (void)Psi, (void)M, (void)C, (void)A;
    const zd_number z0 = ZD_NUM(1.0);
    const zd_number z2 = p[4];
    const zd_number z7 = k[0];
    const zd_number z8 = k[3];
    const zd_number z9 = k[4];
    const zd_number z10 = k[1];
    const zd_number z12 = p[3];
    const zd_number z23 = p[2];
    const zd_number angle3[2] = {z2, z12};
    zd_number sin3[2], cos3[2];
    ZD_TURNS(2, angle3, sin3, cos3);
    const zd_number z3 = sin3[0];
    const zd_number z4 = cos3[0];
    const zd_number z13 = sin3[1];
    const zd_number z14 = cos3[1];
    const zd_number z5 = ZD_DIV(z0, z4);
    const zd_number z6 = ZD_DIV(z3, z4);
    const zd_number z11 = ZD_MUL(z3, z10);
    const zd_number z15 = ZD_MUL(z10, z13);
    const zd_number z16 = ZD_NEG(z15);
    const zd_number z17 = ZD_MUL(z4, z10);
    const zd_number z18 = ZD_MUL(z17, z14);
    const zd_number z19 = ZD_NEG(z18);
    const zd_number z20 = ZD_MUL(z10, z14);
    const zd_number z21 = ZD_MUL(z17, z13);
    const zd_number z22 = ZD_NEG(z21);
    const zd_number z24 = ZD_SUB(z23, z17);
    Phi[0] = z24;
    Psi[0] = ZD_ADD(ZD_ADD(ZD_NUM(0.0), ZD_MUL(z0, v[2])), ZD_MUL(z11, v[4]));
    Psi[1] = ZD_ADD(ZD_ADD(ZD_ADD(ZD_NUM(0.0), ZD_MUL(z0, v[0])), ZD_MUL(z16, v[3])), ZD_MUL(z19, v[4]));
    Psi[2] = ZD_ADD(ZD_ADD(ZD_ADD(ZD_NUM(0.0), ZD_MUL(z0, v[1])), ZD_MUL(z20, v[3])), ZD_MUL(z22, v[4]));
    M[0] = z7.high;
    M[7] = z7.high;
    M[14] = z7.high;
    M[21] = z8.high;
    M[28] = z9.high;
    M[35] = z9.high;
    C[2] = z0.high;
    C[4] = z11.high;
    C[6] = z0.high;
    C[9] = z16.high;
    C[10] = z19.high;
    C[13] = z0.high;
    C[15] = z20.high;
    C[16] = z22.high;
    A[0] = z0.high;
    A[7] = z0.high;
    A[14] = z0.high;
    A[23] = z5.high;
    A[28] = z0.high;
    A[33] = z0.high;
    A[35] = z6.high;
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
const zd_precise zd_rolling_disc_precise = {2 * ROWS, precise_series, precise_residuals, zd_series_value};
