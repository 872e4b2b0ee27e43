#define ZD_SERIES_SIZE 6
#define ZD_SERIES_DOUBLE_DOUBLE
/* Written by python/write_series.py with SymPy 1.14.0, from tests/symbolic_counterparts.py. */
#include <math.h>
#include "../../include/zerodrift/series.h"
#include "../../include/zerodrift/system.h"
#include "precise.h"

#define ZD_SERIES_NUMBERS data
#include "../series/vertical_disc_series.h"

ZD_DD_RARE int residuals(const zd_number *restrict k, zd_number t, const zd_number *restrict p,
    const zd_number *restrict v, zd_number *restrict Phi, zd_number *restrict Psi, double *restrict M,
    double *restrict C, double *restrict A)
{
    (void)k, (void)t, (void)p, (void)v, (void)Phi, (void)Psi, (void)M, (void)C, (void)A;
    const zd_number z0 = k[0];
    const zd_number z2 = k[3];
    const zd_number z3 = k[2];
    const zd_number z4 = ZD_NUM(1.0);
    const zd_number z5 = k[1];
    const zd_number z6 = p[2];
    const zd_number angle7[1] = {z6};
    zd_number sin7[1], cos7[1];
    ZD_TURNS(1, angle7, sin7, cos7);
    const zd_number z7 = sin7[0];
    const zd_number z8 = cos7[0];
    const zd_number z9 = ZD_MUL(z8, z5);
    const zd_number z10 = ZD_NEG(z9);
    const zd_number z11 = ZD_MUL(z5, z7);
    const zd_number z12 = ZD_NEG(z11);
    Psi[0] = ZD_ADD(ZD_ADD(ZD_NUM(0.0), ZD_MUL(z4, v[0])), ZD_MUL(z10, v[3]));
    Psi[1] = ZD_ADD(ZD_ADD(ZD_NUM(0.0), ZD_MUL(z4, v[1])), ZD_MUL(z12, v[3]));
    M[0] = z0.high;
    M[5] = z0.high;
    M[10] = z2.high;
    M[15] = z3.high;
    C[0] = z4.high;
    C[3] = z10.high;
    C[5] = z4.high;
    C[7] = z12.high;
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
const zd_precise zd_vertical_disc_precise = {2 * ROWS, precise_series, precise_residuals, zd_series_value};
