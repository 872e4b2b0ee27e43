/* Terms of the knife edge and the Chaplygin sleigh: an edge at (x, y) in the direction phi that moves along itself only. */
#ifndef ZD_SKATE_H
#define ZD_SKATE_H

#include <math.h>
#include <string.h>

#include "../include/zerodrift/system.h"

enum { ZD_SKATE_X, ZD_SKATE_Y, ZD_SKATE_PHI, ZD_SKATE_N };

typedef struct zd_skate_launch {
    double heading;     /* rad */
    double speed;       /* m/s, along the edge */
    double turn_rate;   /* rad/s */
} zd_skate_launch;

extern const zd_variable zd_skate_coordinate[], zd_skate_velocity[], zd_skate_constraint[];

/* D (3, 2) of (14) and gamma (3,) of (15), for the independent velocities u = [speed along the edge, turn rate]. */
void zd_skate_complement(double sine, double cosine, double *D);
void zd_skate_gamma(double sine, double cosine, const double *v, double *gamma);
/* A consistent start from the origin. */
void zd_skate_start(const zd_skate_launch *launch, double *p, double *v);
/* Transforms an outline, given in m along and across the edge, to the position of the edge. */
void zd_skate_draw(int n, const double (*outline)[2], const double *p, double *points);

#endif
