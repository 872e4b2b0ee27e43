/* Polynomials between the ends of a step of an explicit Runge-Kutta method, of share x = (t - t0) / h and z = 1 - x:
 *
 *     y0 + x (F0 + z (F1 + x (F2 + z (F3 + ...))))
 *
 * F0, F1 and F2 follow from the states and their rates at both ends; the others are sums over all stages, h sum_j d_ij k_j.
 */
#ifndef ZD_INTERPOLATION_H
#define ZD_INTERPOLATION_H

#include "runge_kutta.h"

enum { ZD_OF_ENDS = 3 };    /* coefficients that follow from both ends */

/* sum_j weight_j k_j of an entry, over all stages there are */
ZD_INLINE double zd_summed(int i, const int size, const int all, const double *weight, const double *k)
{
    double sum = 0;
    ZD_UNROLL
    for (int j = 0; j < all; j++)
        if (weight[j] != 0) sum += weight[j] * k[j * size + i];
    return sum;
}

/* to <- h sum_j weight_j k_j */
ZD_INLINE void zd_add_up(const int size, const int all, const double *weight, double h, const double *k, double *to)
{
    ZD_UNROLL
    for (int i = 0; i + 1 < size; i += 2)
        zd_store_pair(h * zd_summed(i, size, all, weight, k), h * zd_summed(i + 1, size, all, weight, k), to + i);
    if (size % 2) to[size - 1] = h * zd_summed(size - 1, size, all, weight, k);
}

/* The coefficients, each a vector; the rate at the end comes behind those of the stages, and those of further stages behind that. */
ZD_INLINE int zd_spread_sized(const int size, const zd_tableau *T, const zd_runge_kutta *self, const zd_rate *rate, double t, double h,
                              const double *y0, const double *y1)
{
    const int first = T->stages + 1, all = first + T->more;
    double *k = self->k, *F = self->polynomial, *f1 = k + T->stages * size;
    int status = rate->evaluate(rate->context, t + h, y1, f1);
    ZD_UNROLL
    for (int i = 0; i < T->more; i++) {
        if (status) return status;
        zd_combine_pairs(0, size, size, first + i, T->more_a + i * all, h, k, y0, self->stage, NULL);
        status = zd_rate_of_stage(rate, t + T->more_c[i] * h, self->stage, k + (first + i) * size);
    }
    for (int i = 0; i < size; i++) {
        const double change = y1[i] - y0[i];
        F[i] = change;
        F[size + i] = h * k[i] - change;
        F[2 * size + i] = 2 * change - h * (f1[i] + k[i]);
    }
    ZD_UNROLL
    for (int i = ZD_OF_ENDS; i < T->coefficients; i++) zd_add_up(size, all, T->d + (i - ZD_OF_ENDS) * all, h, k, F + i * size);
    return status;
}

/* Of three and four coordinates with as many velocities, whose sums are written out; and of any */
ZD_INLINE int zd_runge_kutta_spread(const zd_tableau *T, const zd_runge_kutta *self, const zd_rate *rate, double t, double h, const double *y0,
                                    const double *y1)
{
    return self->size == 6   ? zd_spread_sized(6, T, self, rate, t, h, y0, y1)
         : self->size == 8   ? zd_spread_sized(8, T, self, rate, t, h, y0, y1)
                             : zd_spread_sized(self->size, T, self, rate, t, h, y0, y1);
}

ZD_INLINE void zd_runge_kutta_between(const int coefficients, const zd_runge_kutta *self, double x, const double *y0, double *y)
{
    const int n = self->size;
    const double *F = self->polynomial, z = 1 - x;
    for (int i = 0; i < n; i++) {
        double value = F[(coefficients - 1) * n + i];
        ZD_UNROLL
        for (int k = coefficients - 2; k >= 0; k--) value = F[k * n + i] + (k % 2 ? x : z) * value;
        y[i] = y0[i] + x * value;
    }
}

/* The functions of a method whose table is `tableau`, and their place in its descriptor. */
#define ZD_RUNGE_KUTTA_INTERPOLATION                                                                                        \
    static int spread(void *self, const zd_rate *rate, double t, double h, const double *y0, const double *y1)              \
    {                                                                                                                       \
        return zd_runge_kutta_spread(&tableau, self, rate, t, h, y0, y1);                                                   \
    }                                                                                                                       \
    static void between(const void *self, double share, const double *y0, double *y)                                        \
    {                                                                                                                       \
        zd_runge_kutta_between(tableau.coefficients, self, share, y0, y);                                                   \
    }
#define ZD_INTERPOLATED .spread = spread, .between = between

#endif
