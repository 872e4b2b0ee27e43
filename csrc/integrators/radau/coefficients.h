/* The numbers of Radau's method IIA with three stages: Hairer and Wanner, section IV.8. */
#ifndef ZD_RADAU_COEFFICIENTS_H
#define ZD_RADAU_COEFFICIENTS_H

#include "../../linalg/small.h"

enum { ZD_RADAU_STAGES = 3 };

/* The eigenvalues of A^-1: Lambda = [[gamma, 0, 0], [0, alpha, beta], [0, -beta, alpha]] */
#define ZD_RADAU_GAMMA 3.6378342527444957322
#define ZD_RADAU_ALPHA 2.6810828736277521339
#define ZD_RADAU_BETA 3.0504301992474105694

static const double zd_radau_c[ZD_RADAU_STAGES] = {0.15505102572168219018, 0.64494897427831780982, 1};

/* A^-1 = T Lambda T^-1 */
static const double zd_radau_T[ZD_RADAU_STAGES][ZD_RADAU_STAGES] = {
    {0.0944387624889752415, -0.141255295020954208, 0.0300291941051474245},
    {0.250213122965333311, 0.204129352293799932, -0.382942112757261938},
    {1, 1, 0},
};
static const double zd_radau_T_inverse[ZD_RADAU_STAGES][ZD_RADAU_STAGES] = {
    {4.17871859155190473, 0.327682820761062387, 0.523376445499449548},
    {-4.17871859155190473, -0.327682820761062387, 0.476623554500550452},
    {0.502872634945786876, -2.57192694985560543, 0.596039204828224925},
};

/* to (stages, n) <- matrix (stages, stages) times from */
ZD_INLINE void zd_radau_transform(const int n, const double matrix[ZD_RADAU_STAGES][ZD_RADAU_STAGES], const double *restrict from,
                                  double *restrict to)
{
    for (int s = 0; s < ZD_RADAU_STAGES; s++)
        for (int i = 0; i < n; i++) to[s * n + i] = matrix[s][0] * from[i] + matrix[s][1] * from[n + i] + matrix[s][2] * from[2 * n + i];
}

/* The value at a share of the step of the polynomial through 0 and the three stages z */
ZD_INLINE double zd_radau_dense_output(const double *z, int n, double x)
{
    double sum = 0;
    for (int i = 0; i < ZD_RADAU_STAGES; i++) {
        double basis = x / zd_radau_c[i];
        for (int j = 0; j < ZD_RADAU_STAGES; j++)
            if (j != i) basis *= (x - zd_radau_c[j]) / (zd_radau_c[i] - zd_radau_c[j]);
        sum += basis * z[i * n];
    }
    return sum;
}

#endif
