#define ZD_SERIES_SIZE 3
#define ZD_SERIES_DOUBLE_DOUBLE
/* Written by python/write_series.py with SymPy 1.14.0, from tests/support/symbolic_counterparts.py. */
#include <math.h>
#include "../../include/zerodrift/series.h"
#include "../../include/zerodrift/system.h"
#include "series.h"

#define ZD_SERIES_NUMBERS data
#include "pendulum_series.h"

ZD_DD_RARE int residuals(const zd_number *restrict k, zd_number t, const zd_number *restrict p,
    const zd_number *restrict v, zd_number *restrict Phi, zd_number *restrict Psi, double *restrict M,
    double *restrict C, double *restrict A)
{
    (void)k, (void)t, (void)p, (void)v, (void)Phi, (void)Psi, (void)M, (void)C, (void)A;
    const zd_number z0 = k[1];
    const zd_number z2 = k[0];
    const zd_number z3 = ZD_NUM(1.0);
    const zd_number z4 = ZD_DIV(z3, z2);
    const zd_number z5 = p[0];
    const zd_number z6 = ZD_MUL(z5, z4);
    const zd_number z7 = p[1];
    const zd_number z8 = ZD_MUL(z7, z4);
    const zd_number z9 = ZD_NUM(0.5);
    const zd_number z10 = ZD_MUL(z4, z9);
    const zd_number z11 = ZD_MUL(z2, z2);
    const zd_number z12 = ZD_MUL(z5, z5);
    const zd_number z13 = ZD_SUB(z12, z11);
    const zd_number z14 = ZD_MUL(z7, z7);
    const zd_number z15 = ZD_ADD(z14, z13);
    const zd_number z16 = ZD_MUL(z15, z10);
    Phi[0] = z16;
    Psi[0] = ZD_ADD(ZD_ADD(ZD_NUM(0.0), ZD_MUL(z6, v[0])), ZD_MUL(z8, v[1]));
    M[0] = z0.high;
    M[3] = z0.high;
    C[0] = z6.high;
    C[1] = z8.high;
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
const zd_precise zd_pendulum_precise = {2 * ROWS, precise_series, precise_residuals, zd_series_value};
