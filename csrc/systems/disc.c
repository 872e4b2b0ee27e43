#include "disc.h"

#include <math.h>

#include "../include/zerodrift/sines.h"

static const double TURN = 0x1.921fb54442d18p+2;    /* rad */

void zd_draw_disc(const double *centre, double radius, const double *up, const double *ahead, double turn, double *points)
{
    for (int k = 0; k < ZD_DISC_POINTS; k++) {
        double angle = turn + TURN * (k - 1) / (ZD_DISC_POINTS - 2), r = k ? radius : 0;    /* first the centre */
        for (int i = 0; i < 3; i++) points[3 * k + i] = centre[i] + r * (zd_cos(angle) * up[i] + zd_sin(angle) * ahead[i]);
    }
}
