#define ZD_SERIES_SIZE 5
#define ZD_SERIES_DOUBLE_DOUBLE
/* Written by python/write_series.py with SymPy 1.14.0, from tests/support/symbolic_counterparts.py. */
#include <math.h>
#include "../../include/zerodrift/series.h"
#include "../../include/zerodrift/system.h"
#include "series.h"

#define ZD_SERIES_NUMBERS data
#include "four_bar_series.h"

ZD_DD_RARE int residuals(const zd_number *restrict k, zd_number t, const zd_number *restrict p,
    const zd_number *restrict v, zd_number *restrict Phi, zd_number *restrict Psi, double *restrict M,
    double *restrict C, double *restrict A)
{
    (void)k, (void)t, (void)p, (void)v, (void)Phi, (void)Psi, (void)M, (void)C, (void)A;
    const zd_number z0 = k[5];
    const zd_number z1 = ZD_NUM(0.25);
    const zd_number z2 = k[4];
    const zd_number z3 = ZD_MUL(z2, z1);
    const zd_number z4 = ZD_ADD(z3, z0);
    const zd_number z5 = k[6];
    const zd_number z6 = ZD_ADD(z5, z4);
    const zd_number z7 = k[1];
    const zd_number z8 = ZD_MUL(z7, z7);
    const zd_number z9 = ZD_MUL(z8, z6);
    const zd_number z10 = k[7];
    const zd_number z11 = ZD_ADD(z10, z9);
    const zd_number z12 = k[2];
    const zd_number z13 = ZD_MUL(z7, z12);
    const zd_number z14 = ZD_NUM(0.5);
    const zd_number z15 = ZD_MUL(z0, z14);
    const zd_number z16 = ZD_ADD(z5, z15);
    const zd_number z17 = ZD_MUL(z16, z13);
    const zd_number z18 = p[1];
    const zd_number z19 = p[0];
    const zd_number z20 = ZD_SUB(z19, z18);
    const zd_number z24 = ZD_MUL(z7, z5);
    const zd_number z25 = k[3];
    const zd_number z26 = ZD_MUL(z25, z24);
    const zd_number z27 = ZD_MUL(z14, z26);
    const zd_number z28 = p[2];
    const zd_number z29 = ZD_SUB(z19, z28);
    const zd_number z33 = ZD_MUL(z1, z0);
    const zd_number z34 = ZD_ADD(z5, z33);
    const zd_number z35 = ZD_MUL(z12, z12);
    const zd_number z36 = ZD_MUL(z35, z34);
    const zd_number z37 = k[8];
    const zd_number z38 = ZD_ADD(z37, z36);
    const zd_number z39 = ZD_MUL(z5, z12);
    const zd_number z40 = ZD_MUL(z25, z39);
    const zd_number z41 = ZD_MUL(z14, z40);
    const zd_number z42 = ZD_SUB(z18, z28);
    const zd_number z46 = ZD_MUL(z1, z5);
    const zd_number z47 = ZD_MUL(z25, z25);
    const zd_number z48 = ZD_MUL(z47, z46);
    const zd_number z49 = k[9];
    const zd_number z50 = ZD_ADD(z49, z48);
    const zd_number z66 = k[0];
    const zd_number angle21[6] = {z20, z29, z42, z19, z18, z28};
    zd_number sin21[6], cos21[6];
    ZD_TURNS(6, angle21, sin21, cos21);
    const zd_number z22 = cos21[0];
    const zd_number z31 = cos21[1];
    const zd_number z44 = cos21[2];
    const zd_number z51 = sin21[3];
    const zd_number z52 = cos21[3];
    const zd_number z55 = sin21[4];
    const zd_number z56 = cos21[4];
    const zd_number z59 = sin21[5];
    const zd_number z60 = cos21[5];
    const zd_number z23 = ZD_MUL(z22, z17);
    const zd_number z32 = ZD_MUL(z31, z27);
    const zd_number z45 = ZD_MUL(z44, z41);
    const zd_number z53 = ZD_MUL(z7, z51);
    const zd_number z54 = ZD_NEG(z53);
    const zd_number z57 = ZD_MUL(z12, z55);
    const zd_number z58 = ZD_NEG(z57);
    const zd_number z61 = ZD_MUL(z25, z59);
    const zd_number z62 = ZD_NEG(z61);
    const zd_number z63 = ZD_MUL(z7, z52);
    const zd_number z64 = ZD_MUL(z12, z56);
    const zd_number z65 = ZD_MUL(z25, z60);
    const zd_number z67 = ZD_SUB(z63, z66);
    const zd_number z68 = ZD_ADD(z64, z67);
    const zd_number z69 = ZD_ADD(z65, z68);
    const zd_number z70 = ZD_ADD(z53, z57);
    const zd_number z71 = ZD_ADD(z61, z70);
    Phi[0] = z69;
    Phi[1] = z71;
    Psi[0] = ZD_ADD(ZD_ADD(ZD_ADD(ZD_NUM(0.0), ZD_MUL(z54, v[0])), ZD_MUL(z58, v[1])), ZD_MUL(z62, v[2]));
    Psi[1] = ZD_ADD(ZD_ADD(ZD_ADD(ZD_NUM(0.0), ZD_MUL(z63, v[0])), ZD_MUL(z64, v[1])), ZD_MUL(z65, v[2]));
    M[0] = z11.high;
    M[1] = z23.high;
    M[2] = z32.high;
    M[3] = z23.high;
    M[4] = z38.high;
    M[5] = z45.high;
    M[6] = z32.high;
    M[7] = z45.high;
    M[8] = z50.high;
    C[0] = z54.high;
    C[1] = z58.high;
    C[2] = z62.high;
    C[3] = z63.high;
    C[4] = z64.high;
    C[5] = z65.high;
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
const zd_precise zd_four_bar_precise = {2 * ROWS, precise_series, precise_residuals, zd_series_value};
