/* Picture of the rolling discs: the rim, and a radius that shows the rotation. */
#ifndef ZD_DISC_H
#define ZD_DISC_H

enum { ZD_DISC_POINTS = 50 };

/* `up` and `ahead` are orthogonal unit vectors in the disc's plane; `turn` is the angle of the marked radius from `up`
 * towards `ahead`. Writes ZD_DISC_POINTS points of 3 coordinates. */
void zd_draw_disc(const double *centre, double radius, const double *up, const double *ahead, double turn, double *points);

#endif
