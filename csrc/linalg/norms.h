/* The largest of some numbers, by which sizes, errors and tolerances are compared. */
#ifndef ZD_NORMS_H
#define ZD_NORMS_H

double zd_max_abs(int n, const double *x);      /* of |x_i|; infinite if any is not a number */
double zd_max_scaled(int n, const double *x, const double *scale);      /* of |x_i| scale_i, likewise */
double zd_root_mean_square(int n, const double *x, const double *scale);        /* of x_i / scale_i; 0 of none */
int zd_is_finite(int n, const double *x);       /* whether all of them are numbers, and finite */

#endif
