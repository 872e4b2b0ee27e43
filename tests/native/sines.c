/* The sines of <zerodrift/sines.h>, `beside` of them at a time. */
#include <zerodrift/sines.h>

void sines(int n, int beside, const double *angle, double *s, double *c)
{
    for (int i = 0; i < n; i += beside) {
        const double *at = angle + i;
        switch (beside) {
        case 1: zd_sines(1, at, s + i, c + i); break;
        case 2: zd_sines(2, at, s + i, c + i); break;
        case 3: zd_sines(3, at, s + i, c + i); break;
        case 4: zd_sines(4, at, s + i, c + i); break;
        case 5: zd_sines(5, at, s + i, c + i); break;
        case 8: zd_sines(8, at, s + i, c + i); break;
        default: zd_sines(beside, at, s + i, c + i);
        }
    }
}

void each_by_itself(int n, const double *angle, double *s, double *c)
{
    for (int i = 0; i < n; i++) s[i] = zd_sin(angle[i]), c[i] = zd_cos(angle[i]);
}
