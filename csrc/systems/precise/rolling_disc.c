#define ZD_SERIES_SIZE 9
#define ZD_SERIES_DOUBLE_DOUBLE
/* Written by python/write_series.py with SymPy 1.14.0, from tests/symbolic_counterparts.py. */
#include <math.h>
#include "../../include/zerodrift/series.h"
#include "../../include/zerodrift/system.h"
#include "precise.h"

#define ZD_SERIES_NUMBERS data
#include "../series/rolling_disc_series.h"

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
