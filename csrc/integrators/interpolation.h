/* Polynomials between the ends of a step of an explicit Runge-Kutta method, of share x = (t - t0) / h and z = 1 - x:
 *
 *     y0 + x (F0 + z (F1 + x (F2 + z (F3 + ...))))
 *
 * F0 = y1 - y0, F1 = h k0 - F0 and F2 = 2 F0 - h (f1 + k0) follow from the states and their rates at both ends; the others are sums over all
 * stages, h sum_j d_ij k_j. At one x all of it is y0, a share of F0, and one sum of the stages: their weights are found first, which takes
 * less than the vectors F_i wherever a step has fewer than some ten values in it.
 */
#pragma once

#include "runge_kutta.h"

enum { ZD_OF_ENDS = 3 };    /* coefficients that follow from both ends */

/* to <- y + h sum_j weight_j k_j, h coming last, so that weights are constants */
ZD_INLINE double zd_added(int i, const int size, const int terms, const double *weight, double h, const double *k, const double *y)
{
    double sum = 0;
    int is_first = 1;
    ZD_UNROLL
    for (int j = 0; j < terms; j++) {
        if (weight[j] == 0) continue;
        sum = is_first ? weight[j] * k[j * size + i] : sum + weight[j] * k[j * size + i];
        is_first = 0;
    }
    return y[i] + h * sum;
}

/* n of the entries, the first being `begin`, also to `copy` */
ZD_INLINE void zd_add_stages(const int begin, const int n, const int size, const int terms, const double *weight, double h, const double *k,
                             const double *y, double *to, double *copy)
{
    for (int i = begin; i + 1 < begin + n; i += 2) {
        const double a = zd_added(i, size, terms, weight, h, k, y), b = zd_added(i + 1, size, terms, weight, h, k, y);
        zd_store_pair(a, b, to + i);
        if (copy) zd_store_pair(a, b, copy + i - begin);
    }
    if (n % 2 == 0) return;
    to[begin + n - 1] = zd_added(begin + n - 1, size, terms, weight, h, k, y);
    if (copy) copy[n - 1] = to[begin + n - 1];
}

/* The stages that the polynomial has besides, behind the rate at the end: of n coordinates whose rates are the n velocities, and of these by
 * a closed-form function alone; and of any state. */
ZD_INLINE int zd_prepare_dense_in_closed_form(const int n, const zd_tableau *T, const zd_runge_kutta *self, const zd_rate *rate, double t,
                                              double h, const double *y0)
{
    const int first = T->stages + 1, all = first + T->more, size = 2 * n;
    double *stage = self->stage;
    int status = ZD_DONE;
    ZD_UNROLL
    for (int i = 0; i < T->more; i++) {
        double *rates = self->k + (first + i) * size;
        const double *weight = T->more_a + i * all, of_stage = t + T->more_c[i] * h;
        if (status) return ZD_CALLBACK;
        zd_add_stages(0, n, size, first + i, weight, h, self->k, y0, stage, NULL);
        zd_add_stages(n, n, size, first + i, weight, h, self->k, y0, stage, rates);
        status = rate->closed_form->accelerate(rate->closed_form, rate->system->data, rate->inputs, &of_stage, stage, stage + n, NULL, NULL,
                                               rates + n, NULL, NULL, NULL);
    }
    return status ? ZD_CALLBACK : ZD_DONE;
}

ZD_INLINE int zd_prepare_dense_in_general(const int size, const zd_tableau *T, const zd_runge_kutta *self, const zd_rate *rate, double t,
                                          double h, const double *y0)
{
    const int first = T->stages + 1, all = first + T->more;
    int status = ZD_DONE;
    ZD_UNROLL
    for (int i = 0; i < T->more; i++) {
        if (status) return status;
        zd_add_stages(0, size, size, first + i, T->more_a + i * all, h, self->k, y0, self->stage, NULL);
        status = zd_rate_of_stage(rate, t + T->more_c[i] * h, self->stage, self->k + (first + i) * size);
    }
    return status;
}

/* Three and four coordinates with as many velocities are those whose sums are written out. */
ZD_INLINE int zd_runge_kutta_prepare_dense(const zd_tableau *T, zd_runge_kutta *self, const zd_rate *rate, double t, double h,
                                           const double *y0, const double *y1)
{
    const int size = self->size, is_plain = rate->closed_form && !(rate->system->provides & ZD_A);
    self->h = h;
    for (int i = 0; i < size; i++) self->change[i] = y1[i] - y0[i];
    int status = zd_rate_of_beginning(rate, t + h, y1, self->k + T->stages * size);
    return status || !T->more    ? status
         : is_plain && size == 6 ? zd_prepare_dense_in_closed_form(3, T, self, rate, t, h, y0)
         : is_plain && size == 8 ? zd_prepare_dense_in_closed_form(4, T, self, rate, t, h, y0)
         : size == 6             ? zd_prepare_dense_in_general(6, T, self, rate, t, h, y0)
                                 : zd_prepare_dense_in_general(size, T, self, rate, t, h, y0);
}

/* weight (all,) <- weights of the rates k_j, times h, at a fraction x of the step */
ZD_INLINE void zd_weigh_stages(const zd_tableau *T, double h, double x, double *weight)
{
    const int all = T->stages + 1 + T->more, sums = T->coefficients - ZD_OF_ENDS;
    const double z = 1 - x, of_sums = h * x * z * x * z;
    for (int j = 0; j < all; j++) {
        double sum = T->d[(sums - 1) * all + j];
        ZD_UNROLL
        for (int i = sums - 2; i >= 0; i--) sum = T->d[i * all + j] + (i % 2 ? z : x) * sum;
        weight[j] = of_sums * sum;
    }
    weight[0] += h * x * z * z;             /* F1 and F2 */
    weight[T->stages] -= h * x * z * x;
}

ZD_INLINE double zd_dense_output_value(int i, const int size, const zd_tableau *T, const zd_runge_kutta *self, double of_change,
                                  const double *weight, const double *y0)
{
    double value = y0[i] + of_change * self->change[i];
    ZD_UNROLL
    for (int j = 0; j < T->stages + 1 + T->more; j++)
        if (T->d[j] != 0) value += weight[j] * self->k[j * size + i];
    return value;
}

ZD_INLINE void zd_dense_output_sized(const int size, const zd_tableau *T, const zd_runge_kutta *self, double x, const double *y0, double *y)
{
    const double z = 1 - x, of_change = x * x * (x + 3 * z);     /* x - x z + 2 x^2 z */
    double weight[ZD_MAX_STAGES];
    zd_weigh_stages(T, self->h, x, weight);
    for (int i = 0; i + 1 < size; i += 2)
        zd_store_pair(zd_dense_output_value(i, size, T, self, of_change, weight, y0),
                      zd_dense_output_value(i + 1, size, T, self, of_change, weight, y0), y + i);
    if (size % 2) y[size - 1] = zd_dense_output_value(size - 1, size, T, self, of_change, weight, y0);
}

ZD_INLINE void zd_runge_kutta_dense_output(const zd_tableau *T, const zd_runge_kutta *self, double x, const double *y0, double *y)
{
    if (self->size == 6) zd_dense_output_sized(6, T, self, x, y0, y);
    else if (self->size == 8) zd_dense_output_sized(8, T, self, x, y0, y);
    else zd_dense_output_sized(self->size, T, self, x, y0, y);
}

/* The functions of a method whose table is `tableau`, and their place in its descriptor. */
#define ZD_RUNGE_KUTTA_INTERPOLATION                                                                                        \
    static int prepare_dense(void *self, const zd_rate *rate, double t, double h, const double *y0, const double *y1)              \
    {                                                                                                                       \
        return zd_runge_kutta_prepare_dense(&tableau, self, rate, t, h, y0, y1);                                                   \
    }                                                                                                                       \
    static void dense_output(const void *self, double share, const double *y0, double *y)                                        \
    {                                                                                                                       \
        zd_runge_kutta_dense_output(&tableau, self, share, y0, y);                                                   \
    }
#define ZD_INTERPOLATED .prepare_dense = prepare_dense, .dense_output = dense_output
