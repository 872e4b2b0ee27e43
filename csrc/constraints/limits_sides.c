/* Right-hand sides of the limits that replace constraints: limits.c derives them. */
#include <math.h>

#include "../linalg/small.h"
#include "../point/point.h"
#include "limits.h"

static const double NEAREST = 0x1p-18;  /* distance, characteristic scales: nearer to the bifurcation c(v) is more accurate than w v */

/* (wdot - K C_r) x: `product` is wdot x, the rate of the limit w of this row times x, and rhs is C_r x; K is limits->K_rate. */
static double besides_others(const zd_selection *self, int row, double product, const double *rhs)
{
    return product - zd_limits_along_others(self, self->limits->K_rate + row * self->m, rhs, 1);
}

/* Residual of the limit that replaces a constraint, in Phi or Psi: the constraint's own, divided by its distance; at the bifurcation
 * itself from c(v). */
static double violation(const zd_point *point, int j, int row, enum zd_limit what, const double *rhs)
{
    const zd_selection *self = point->rank->selection;
    if (fabs(self->limits->distance[j]) > NEAREST) return zd_limits_own_part(self, row, rhs, 1) / self->limits->distance[j];
    if (what == ZD_LIMIT_PHI) return 0;
    return besides_others(self, row, -zd_limits_own_part(self, row, point->terms.xi, 1) / self->limits->speed / 2, rhs);
}

/* Product of the limit with the velocity that satisfies it: the point's velocity, less its residual. rhs holds -Phi_t. */
static double enforced(const zd_point *point, int j, int row, const double *limit, const double *rhs)
{
    double *Psi = point->rank->selection->lambda;
    int n = point->rank->n;
    for (int k = 0; k < point->rank->m; k++) {
        zd_row_of_C own = zd_point_row(point, k);
        Psi[k] = zd_row_times(&own, point->v) - rhs[k];
    }
    return zd_dot(n, limit, point->v) - violation(point, j, row, ZD_LIMIT_PSI, Psi);
}

int zd_limits_replace_lost(zd_point *point, enum zd_limit what, double *rhs)
{
    const zd_selection *self = point->rank->selection;
    int first = point->holonomic - self->rank->lost, status = zd_point_need(point, ZD_XI);
    for (int j = 0; j < self->rank->lost && !status; j++) {
        int row = self->row_at[first + j];
        rhs[row] = what == ZD_LIMIT_XI ? besides_others(self, row, zd_limits_own_part(self, row, self->limits->xidot, 1) / 3, rhs)
                 : what == ZD_LIMIT_ENFORCED ? enforced(point, j, row, self->C + (first + j) * self->n, rhs)
                 : violation(point, j, row, what, rhs);
    }
    return status;
}
