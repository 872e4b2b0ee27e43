#include "norms.h"

#include "small.h"

double zd_max_abs(int n, const double *x)
{
    return ZD_SIZED(zd_largest, n, x);
}

/* Zero times what is not finite is not a number; the sum has no branches. */
ZD_INLINE int is_finite(const int n, const double *x)
{
    double zero = 0;
    for (int i = 0; i < n; i++) zero += 0 * x[i];
    return zero == 0;
}

int zd_is_finite(int n, const double *x)
{
    return ZD_SIZED(is_finite, n, x);
}

ZD_INLINE double largest_scaled(const int n, const double *x, const double *scale)
{
    double largest = 0;
    int broken = 0;
    for (int i = 0; i < n; i++) {
        double size = fabs(x[i]) * scale[i];
        largest = size > largest ? size : largest;
        broken |= isnan(size);
    }
    return broken ? INFINITY : largest;
}

double zd_max_scaled(int n, const double *x, const double *scale)
{
    return ZD_SIZED(largest_scaled, n, x, scale);
}
