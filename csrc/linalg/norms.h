/* Norms of vectors, for sizes, errors and tolerances. */
#ifndef ZD_NORMS_H
#define ZD_NORMS_H

double zd_max_abs(int n, const double *x);      /* max |x_i|; infinite if any is NaN */
double zd_max_scaled(int n, const double *x, const double *scale);      /* max |x_i| scale_i; infinite if any is NaN */
double zd_root_mean_square(int n, const double *x, const double *scale);        /* root mean square of x_i / scale_i; 0 for n = 0 */
int zd_is_finite(int n, const double *x);       /* true if all x_i are finite */

#endif
