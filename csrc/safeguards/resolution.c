/* Whether steps of fixed size resolve each part of the motion, however light it is.
 *
 * The energy balance and omega h weigh by the whole mechanism, and a light part hardly counts in them. So each coordinate is weighed by
 * itself: where positions, velocities and accelerations of both ends are those of one smooth motion, Hermite's formula
 *
 *     p1 - p0 = h (v0 + v1) / 2 - h^2 (vdot1 - vdot0) / 12 + O(h^5)
 *
 * holds; what is missing is the error of the step, as far as a method of order four can tell. With a kinematic matrix, the rates of p
 * are not v, and the velocities take the place of the coordinates: their own formula of this kind is the trapezoidal rule.
 *
 * What one coordinate misses is added up over a thousand steps or so, in natural units: earlier steps are forgotten, as otherwise every
 * long run would be doubted. Against the sum stands how far that coordinate has gone on its way, and from one end to the other: no more
 * than that can it be off. The factors and bounds are those that separated wrong from right runs best, see tests/stress/light_parts.py.
 */
#include "resolution.h"

#include <math.h>

#include "../linalg/small.h"

static const double FORGET = 1.0 / 128;     /* of the sums at each look; most looks are eight steps apart */
static const double SHARE = 1e-3;           /* of the way: less of an error does not make steps too long */
static const double UNRESOLVED = 0.03;      /* in natural units: so much of an error does, */
static const double NOTED = 1e-3;           /* and less than that is nobody's concern */

/* The error of a step by what Hermite's formula misses, which is better than some methods and worse than others. */
static double error_by_defect(int order)
{
    return order < 5 ? 1 : 0.2;
}

/* The same by what the trapezoidal rule misses; of methods of order two, which that may be itself, by h^2 (vdot1 - vdot0), and of order
 * one by h^2 vdot. */
static double error_by_rate(int order)
{
    return order < 2 ? 1.0 / 2 : order < 4 ? 1.0 / 12 : order < 5 ? 1.0 / 20 : 1.0 / 50;
}

zd_resolution zd_resolution_take(zd_arena *arena, zd_motion *motion, int order, const zd_last *last, const double *vdot0)
{
    size_t n = (size_t)motion->system.nv;
    int rates = (motion->system.provides & ZD_A) != 0;
    return (zd_resolution){
        .motion = motion,
        .last = last,
        .vdot0 = vdot0,
        .rates = rates,
        .order = order,
        .weight = rates ? error_by_rate(order) : error_by_defect(order),
        .error = zd_take_doubles(arena, n),
        .way = zd_take_doubles(arena, n),
        .at = zd_take_doubles(arena, n),
        .least = zd_take_doubles(arena, n),
        .most = zd_take_doubles(arena, n),
    };
}

/* What coordinate i misses in the step, in its own units */
ZD_INLINE double missed(const zd_resolution *self, int i, double h)
{
    const zd_point *point = self->motion->point;
    double before = self->vdot0[i], after = point->vdot[i], v0 = self->last->v[i], v1 = point->v[i];
    if (!self->rates) return point->p[i] - self->last->p[i] - h / 2 * (v0 + v1) + h * h / 12 * (after - before);
    return self->order < 2 ? h * h * after : self->order < 4 ? h * h * (after - before) : h * (v1 - v0 - h / 2 * (before + after));
}

/* Where the coordinate is; or where its velocity has led, as far as the steps that are looked at show. */
ZD_INLINE double place(const zd_resolution *self, int i, double led)
{
    const zd_point *point = self->motion->point;
    return self->rates ? self->at[i] + led : point->p[i] * point->inverse_unit[i];
}

static void note(zd_motion *motion, int i, double error)
{
    zd_statistics *statistics = &motion->statistics;
    if (error > UNRESOLVED && !statistics->unresolved++) statistics->unresolved_time = motion->point->t;
    if (!(error > statistics->part_error)) return;
    statistics->part_error = error;
    statistics->part = i;
}

ZD_INLINE void look(const int n, zd_resolution *self, double h, double steps)
{
    const zd_point *point = self->motion->point;
    const double *inverse_unit = point->inverse_unit;
    const int first = self->step == 0;
    for (int i = 0; i < n; i++) {
        double led = steps * h / 2 * (self->last->v[i] + point->v[i]) * inverse_unit[i], at = place(self, i, led);
        self->error[i] += steps * self->weight * fabs(missed(self, i, h)) * inverse_unit[i] - FORGET * self->error[i];
        self->way[i] += fabs(led) - FORGET * self->way[i];
        self->at[i] = at;
        self->least[i] = first || at < self->least[i] ? at : self->least[i];
        self->most[i] = first || at > self->most[i] ? at : self->most[i];
        double range = self->most[i] - self->least[i], error = self->error[i] < range ? self->error[i] : range;
        if (error > NOTED && error > SHARE * self->way[i]) note(self->motion, i, error);
    }
}

void zd_resolution_look(zd_resolution *self, double h, long step)
{
    ZD_SIZED(look, self->motion->system.nv, self, h, (double)(step - self->step));
    self->step = step;
}
