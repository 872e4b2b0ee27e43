#include "point.h"

#include "../linalg/small.h"

/* Factors a diagonal M: the reciprocals of D. Returns n, or the index of an entry that is not positive. */
static int invert_diagonal(int n, const double *M, double *L)
{
    for (int i = 0; i < n; i++) {
        if (!(M[i] > 0) || !(M[i] < INFINITY)) return i;
        L[i] = 1 / M[i];
    }
    return n;
}

static int factor_block(const zd_layout *layout, int b, const double *M, double *L)
{
    int n = layout->velocity_at[b + 1] - layout->velocity_at[b], at = layout->M_at[b];
    return layout->is_diagonal[b] ? invert_diagonal(n, M + at, L + at) : ZD_SIZED(zd_cholesky, n, M + at, L + at);
}

int zd_mass_factor(const zd_point *point, double *L)
{
    const zd_layout *layout = point->layout;
    const int n = point->system->nv;
    if (!layout) return ZD_SIZED(zd_cholesky, n, point->terms.M, L);
    for (int b = 0; b < layout->blocks; b++) {
        int first = layout->velocity_at[b], found = first + factor_block(layout, b, point->terms.M, L);
        if (found < layout->velocity_at[b + 1]) return found;
    }
    return n;
}

void zd_mass_solve(const zd_layout *layout, const double *L, const double *y, double *x)
{
    for (int b = 0; b < layout->blocks; b++) {
        const int first = layout->velocity_at[b], n = layout->velocity_at[b + 1] - first;
        const double *own = L + layout->M_at[b];
        for (int i = 0; layout->is_diagonal[b] && i < n; i++) x[first + i] = own[i] * y[first + i];
        if (layout->is_diagonal[b]) continue;
        ZD_SIZED(zd_forward, n, own, y + first, x + first);
        ZD_SIZED(zd_backward, n, own, x + first, x + first);
    }
}
