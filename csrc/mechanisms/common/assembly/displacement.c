#include "given.h"

#include <math.h>

/* to <- q turned by a rotation vector x in its own axes, normalized */
static void turn(const double *q, const double *x, double *to)
{
    const double angle = sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]), half = angle / 2;
    const double c = cos(half), s = half > 0 ? sin(half) / half / 2 : 0.5, a = s * x[0], b = s * x[1], d = s * x[2];
    to[0] = q[0] * c - (q[1] * a + q[2] * b + q[3] * d);
    to[1] = q[0] * a + c * q[1] + (q[2] * d - q[3] * b);
    to[2] = q[0] * b + c * q[2] + (q[3] * a - q[1] * d);
    to[3] = q[0] * d + c * q[3] + (q[1] * b - q[2] * a);
    const double length = sqrt((to[0] * to[0] + to[1] * to[1]) + (to[2] * to[2] + to[3] * to[3]));
    for (int i = 0; i < 4; i++) to[i] /= length;
}

/* x <- rotation vector, in the axes of q, of the shorter rotation from q to `to` */
static void turn_between(const double *q, const double *to, double *x)
{
    const double c = q[0] * to[0] + q[1] * to[1] + q[2] * to[2] + q[3] * to[3], sign = c < 0 ? -1 : 1;
    x[0] = sign * (q[0] * to[1] - q[1] * to[0] - (q[2] * to[3] - q[3] * to[2]));
    x[1] = sign * (q[0] * to[2] - q[2] * to[0] - (q[3] * to[1] - q[1] * to[3]));
    x[2] = sign * (q[0] * to[3] - q[3] * to[0] - (q[1] * to[2] - q[2] * to[1]));
    const double sine = sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]);
    const double factor = sine > 0 ? 2 * atan2(sine, sign * c) / sine : 2;
    for (int i = 0; i < 3; i++) x[i] *= factor;
}

void zd_displace(const zd_system *system, const double *p, const double *x, double *to)
{
    int i = 0;
    for (int j = 0, k = 0; j < system->nv;) {
        if (k < system->quaternions && system->quaternion[k] == i) {
            turn(p + i, x + j, to + i);
            i += 4, j += 3, k++;
        } else {
            to[i] = p[i] + x[j];
            i++, j++;
        }
    }
    for (; i < system->nq; i++) to[i] = p[i];
    if (system->followers) system->follow(system->data, to);
}

void zd_displacement(const zd_system *system, const double *p, const double *other, double *x)
{
    for (int i = 0, j = 0, k = 0; j < system->nv;) {
        if (k < system->quaternions && system->quaternion[k] == i) {
            turn_between(other + i, p + i, x + j);
            i += 4, j += 3, k++;
        } else {
            x[j] = p[i] - other[i];
            i++, j++;
        }
    }
}
