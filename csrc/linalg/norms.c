
#include "small.h"

double zd_max_abs(int n, const double *x)
{
    return ZD_SIZED(zd_largest, n, x);
}

double zd_root_mean_square(int n, const double *x, const double *scale)
{
    double sum = 0;
    for (int i = 0; i < n; i++) sum += (x[i] / scale[i]) * (x[i] / scale[i]);
    return n ? sqrt(sum / n) : 0;
}

/* Zero times what is not finite is not a number; the sum has no branches. */
ZD_INLINE int is_finite(const int n, const double *x)
{
    zd_two zeros = zd_two_of(0, 0);
    for (int i = 0; i + 1 < n; i += 2) zeros = zd_plus_two(zeros, zd_scaled_two(0, zd_two_at(x + i)));
    const double zero = zd_first_of(zeros) + zd_second_of(zeros) + (n % 2 ? 0 * x[n - 1] : 0);
    return zero == 0;
}

int zd_is_finite(int n, const double *x)
{
    return ZD_SIZED(is_finite, n, x);
}

double zd_max_scaled(int n, const double *x, const double *scale)
{
    return ZD_SIZED(zd_largest_scaled, n, x, scale);
}
