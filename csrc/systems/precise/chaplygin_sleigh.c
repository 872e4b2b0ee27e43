#define ZD_SERIES_SIZE 4
#define ZD_SERIES_DOUBLE_DOUBLE
/* Written by python/write_series.py with SymPy 1.14.0, from tests/symbolic_counterparts.py. */
#include <math.h>
#include "../../include/zerodrift/series.h"
#include "../../include/zerodrift/system.h"
#include "precise.h"

#define ZD_SERIES_NUMBERS data
#include "../series/chaplygin_sleigh_series.h"

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
