/* Quintic splines. Between two samples the polynomial of degree five follows from values and both derivatives at its ends. Its third and
 * fourth derivatives are continuous at each inner sample: two equations for the rate r and the second rate s there, with those of both
 * neighbours. Elimination from the first sample to the last leaves x_i = right_i - F_i x_i+1, with x = (r, s). */
#include "../zerodrift.h"

typedef struct pair { double third, fourth; } pair;     /* entries of the two equations */

/* Share of r and s at the earlier neighbour, at distance 1 / h */
static pair of_earlier(double h, double r, double s)
{
    return (pair){24 * h * h * r + 3 * h * s, 168 * h * h * h * r + 24 * h * h * s};
}

/* r and s that solve both equations, whose coefficients are columns of a matrix */
static void solve(pair of_r, pair of_s, pair right, double *r, double *s)
{
    const double scale = 1 / (of_r.third * of_s.fourth - of_s.third * of_r.fourth);
    *r = scale * (of_s.fourth * right.third - of_s.third * right.fourth);
    *s = scale * (of_r.third * right.fourth - of_r.fourth * right.third);
}

void zd_quintic_spline(int64_t samples, int columns, const double *t, const double *value, double *factors, double *rate, double *second)
{
    double *F = factors;
    for (int64_t i = 1; i + 1 < samples; i++) {
        const double h = 1 / (t[i] - t[i - 1]), k = 1 / (t[i + 1] - t[i]), h2 = h * h, k2 = k * k, h3 = h * h2, k3 = k * k2;
        pair of_r = of_earlier(h, F[0], F[1]), of_s = of_earlier(h, F[2], F[3]);
        of_r.third += 36 * (k2 - h2), of_r.fourth -= 192 * (h3 + k3);
        of_s.third += 9 * (h + k), of_s.fourth += 36 * (h2 - k2);
        F += 4;
        solve(of_r, of_s, (pair){24 * k2, -168 * k3}, F, F + 1);
        solve(of_r, of_s, (pair){-3 * k, 24 * k2}, F + 2, F + 3);
        for (int64_t j = i * columns; j < (i + 1) * columns; j++) {
            const double before = h3 * (value[j] - value[j - columns]), after = k3 * (value[j + columns] - value[j]);
            pair right = of_earlier(h, rate[j - columns], second[j - columns]);
            right.third += 60 * (after - before), right.fourth -= 360 * (k * after + h * before);
            solve(of_r, of_s, right, rate + j, second + j);
        }
    }
    for (int64_t j = (samples - 1) * columns - 1; j >= columns; j--) {
        const double *of = factors + 4 * (j / columns), r = rate[j + columns], s = second[j + columns];
        rate[j] -= of[0] * r + of[2] * s;
        second[j] -= of[1] * r + of[3] * s;
    }
}
