#define ZD_SERIES_SIZE 5
#define ZD_SERIES_DOUBLE_DOUBLE
/* Written by python/write_series.py with SymPy 1.14.0, from tests/symbolic_counterparts.py. */
#include <math.h>
#include "../../include/zerodrift/series.h"
#include "../../include/zerodrift/system.h"
#include "precise.h"

#define ZD_SERIES_NUMBERS data
#include "../series/slider_crank_series.h"

ZD_DD_RARE int residuals(const zd_number *restrict k, zd_number t, const zd_number *restrict p,
    const zd_number *restrict v, zd_number *restrict Phi, zd_number *restrict Psi, double *restrict M,
    double *restrict C, double *restrict A)
{
    (void)k, (void)t, (void)p, (void)v, (void)Phi, (void)Psi, (void)M, (void)C, (void)A;
    const zd_number z0 = k[2];
    const zd_number z2 = k[3];
    const zd_number z3 = k[4];
    const zd_number z4 = k[0];
    const zd_number z5 = p[0];
    const zd_number z9 = ZD_NUM(1.0);
    const zd_number z10 = k[1];
    const zd_number z11 = p[2];
    const zd_number z20 = p[1];
    const zd_number angle6[2] = {z5, z11};
    zd_number sin6[2], cos6[2];
    ZD_TURNS(2, angle6, sin6, cos6);
    const zd_number z6 = sin6[0];
    const zd_number z7 = cos6[0];
    const zd_number z12 = sin6[1];
    const zd_number z13 = cos6[1];
    const zd_number z8 = ZD_MUL(z6, z4);
    const zd_number z14 = ZD_MUL(z12, z10);
    const zd_number z15 = ZD_MUL(z4, z7);
    const zd_number z16 = ZD_NEG(z15);
    const zd_number z17 = ZD_MUL(z10, z13);
    const zd_number z18 = ZD_NEG(z17);
    const zd_number z19 = ZD_ADD(z15, z17);
    const zd_number z21 = ZD_SUB(z20, z19);
    const zd_number z22 = ZD_ADD(z8, z14);
    const zd_number z23 = ZD_NEG(z22);
    Phi[0] = z21;
    Phi[1] = z23;
    Psi[0] = ZD_ADD(ZD_ADD(ZD_ADD(ZD_NUM(0.0), ZD_MUL(z8, v[0])), ZD_MUL(z9, v[1])), ZD_MUL(z14, v[2]));
    Psi[1] = ZD_ADD(ZD_ADD(ZD_NUM(0.0), ZD_MUL(z16, v[0])), ZD_MUL(z18, v[2]));
    M[0] = z0.high;
    M[4] = z2.high;
    M[8] = z3.high;
    C[0] = z8.high;
    C[1] = z9.high;
    C[2] = z14.high;
    C[3] = z16.high;
    C[5] = z18.high;
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
const zd_precise zd_slider_crank_precise = {2 * ROWS, precise_series, precise_residuals, zd_series_value};
