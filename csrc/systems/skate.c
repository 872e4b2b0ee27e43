#include "skate.h"

#include "../include/zerodrift/sines.h"

const zd_variable zd_skate_coordinate[] = {{"x", "m"}, {"y", "m"}, {"phi", "rad"}};
const zd_variable zd_skate_velocity[] = {{"x_dot", "m/s"}, {"y_dot", "m/s"}, {"phi_dot", "rad/s"}};
const zd_variable zd_skate_constraint[] = {{"slip", "m/s"}};

void zd_skate_start(const zd_skate_launch *launch, double *p, double *v)
{
    p[ZD_SKATE_X] = p[ZD_SKATE_Y] = 0;
    p[ZD_SKATE_PHI] = launch->heading;
    v[ZD_SKATE_X] = launch->speed * zd_cos(launch->heading);
    v[ZD_SKATE_Y] = launch->speed * zd_sin(launch->heading);
    v[ZD_SKATE_PHI] = launch->turn_rate;
}

void zd_skate_complement(double sine, double cosine, double *D)
{
    const double rows[] = {
        cosine, 0,
        sine, 0,
        0, 1,
    };
    memcpy(D, rows, sizeof rows);                                       /* (14) */
}

void zd_skate_gamma(double sine, double cosine, const double *v, double *gamma)
{
    double along = cosine * v[ZD_SKATE_X] + sine * v[ZD_SKATE_Y], turn = v[ZD_SKATE_PHI];
    gamma[ZD_SKATE_X] = -along * turn * sine;                           /* (15): Ddot u */
    gamma[ZD_SKATE_Y] = along * turn * cosine;
    gamma[ZD_SKATE_PHI] = 0;
}

void zd_skate_draw(int n, const double (*outline)[2], const double *p, double *points)
{
    double s = zd_sin(p[ZD_SKATE_PHI]), c = zd_cos(p[ZD_SKATE_PHI]);
    for (int i = 0; i < n; i++) {
        points[2 * i] = p[ZD_SKATE_X] + c * outline[i][0] - s * outline[i][1];
        points[2 * i + 1] = p[ZD_SKATE_Y] + s * outline[i][0] + c * outline[i][1];
    }
}
