/* Whether steps of fixed size resolve each part of the motion, however light it is.
 *
 * The energy balance and omega h weigh by the whole mechanism, and a light part hardly counts in them. So each coordinate is weighed by
 * itself: where positions, velocities and accelerations of both ends are those of one smooth motion, Hermite's formula
 *
 *     p1 - p0 = h (v0 + v1) / 2 - h^2 (vdot1 - vdot0) / 12 + O(h^5)
 *
 * holds; what is missing is the error of the step, as far as a method of order four can tell. With a kinematic matrix, the rates of p
 * are not v, and the velocities take the place of the coordinates: their own formula of this kind is the trapezoidal rule. Unit quaternions
 * are looked at besides, each as one: turning.c.
 *
 * What one coordinate misses is added up over a thousand steps or so, in natural units: earlier steps are forgotten, as otherwise every
 * long run would be doubted. The sum is compared with the length of that coordinate's path, and is bounded by the range in which it moves: it
 * cannot be off by more than that. The factors and bounds are those that separated wrong from right runs best,
 * see tests/stress/light_parts.py.
 */
#include "resolution.h"

#include <math.h>

#include "../linalg/small.h"

static const double FORGET = 1.0 / 128;     /* of the sums at each look, or of every eight steps between two that are further apart */
static const double SHARE = 1e-3;           /* of the path: steps with a smaller error are short enough */
static const double UNRESOLVED = 0.03;      /* in natural units: the user is told of an error as large as this */
static const double HALF_TURN = 3.141592653589793;
static const double NOTED = 1e-3;           /* in natural units: the statistics do not have smaller ones */
static const double AMPLE = 0x1p-4;         /* of these: what is smaller may be looked at less often */

/* The error of a step by what Hermite's formula misses, which is better than some methods and worse than others. */
static double error_by_defect(int order)
{
    return order < 5 ? 1 : 0.2;
}

/* The same for velocities: by what the trapezoidal rule misses; for methods of order two, of which that rule is one, by h^2 (vdot1 - vdot0),
 * and for methods of order one by h^2 vdot. */
static double error_by_rate(int order)
{
    return order < 2 ? 1.0 / 2 : order < 4 ? 1.0 / 12 : order < 5 ? 1.0 / 20 : 1.0 / 50;
}

zd_resolution zd_resolution_take(zd_arena *arena, zd_motion *motion, int order, const zd_last *last, const double *vdot0,
                                 const double *pdot0, const double *pdot1)
{
    size_t n = (size_t)motion->system.nv, all = n + (size_t)motion->system.quaternions;
    int by_velocity = (motion->system.provides & ZD_A) != 0;
    return (zd_resolution){
        .motion = motion,
        .last = last,
        .vdot0 = vdot0,
        .by_velocity = by_velocity,
        .order = order,
        .weight = by_velocity ? error_by_rate(order) : error_by_defect(order),
        .error = zd_take_doubles(arena, all),
        .path = zd_take_doubles(arena, all),
        .place = zd_take_doubles(arena, by_velocity ? n : 0),
        .lowest = zd_take_doubles(arena, n),
        .highest = zd_take_doubles(arena, n),
        .turning = zd_turning_take(arena, motion, last, vdot0, pdot0, pdot1),
    };
}

/* What coordinate i misses in the step, in its own units */
ZD_INLINE double missed(const zd_resolution *self, int i, double h)
{
    const zd_point *point = self->motion->point;
    double before = self->vdot0[i], after = point->vdot[i], v0 = self->last->v[i], v1 = point->v[i];
    if (!self->by_velocity) return point->p[i] - self->last->p[i] - h / 2 * (v0 + v1) + h * h / 12 * (after - before);
    return self->order < 2 ? h * h * after : self->order < 4 ? h * h * (after - before) : h * (v1 - v0 - h / 2 * (before + after));
}

/* Where the coordinate is; or where its velocity has led, as far as the steps that are looked at show. */
ZD_INLINE double locate(const zd_resolution *self, int i, double led)
{
    const zd_point *point = self->motion->point;
    return self->by_velocity ? self->place[i] + led : point->p[i] * point->inverse_unit[i];
}

/* Whether an error counts, if it is compared with so much of the bounds */
ZD_INLINE int counts(double error, double path, double share)
{
    return error > share * NOTED && error > share * SHARE * path;
}

static double forgotten(double steps)
{
    return steps > 8 ? steps / 8 * FORGET : FORGET;
}

static void note(zd_motion *motion, int i, double error)
{
    zd_statistics *statistics = &motion->statistics;
    if (error > UNRESOLVED && !statistics->unresolved++) statistics->unresolved_time = motion->point->t;
    if (!(error > statistics->part_error)) return;
    statistics->part_error = error;
    statistics->part = i;
}

ZD_INLINE void add_up(const int n, zd_resolution *self, double h, double steps)
{
    const zd_point *point = self->motion->point;
    const double *inverse_unit = point->inverse_unit;
    const int first = self->step == 0;
    const double forget = forgotten(steps);
    int near = 0;
    for (int i = 0; i < n; i++) {
        double led = steps * h / 2 * (self->last->v[i] + point->v[i]) * inverse_unit[i], at = locate(self, i, led);
        self->error[i] += steps * self->weight * fabs(missed(self, i, h)) * inverse_unit[i] - forget * self->error[i];
        self->path[i] += fabs(led) - forget * self->path[i];
        if (self->by_velocity) self->place[i] = at;
        self->lowest[i] = first || at < self->lowest[i] ? at : self->lowest[i];
        self->highest[i] = first || at > self->highest[i] ? at : self->highest[i];
        double range = self->highest[i] - self->lowest[i], error = self->error[i] < range ? self->error[i] : range;
        near |= counts(self->error[i], self->path[i], AMPLE);
        if (counts(error, self->path[i], 1)) note(self->motion, i, error);
    }
    self->is_ample = !near;
}

/* An attitude cannot be off by more than half a turn. */
static void add_up_turns(zd_resolution *self, double h, double steps)
{
    const double forget = forgotten(steps);
    for (int k = 0; k < self->motion->system.quaternions; k++) {
        const int i = self->motion->system.nv + k;
        double missed, turned;
        zd_turning_compare(&self->turning, k, h, &missed, &turned);
        self->error[i] += steps * error_by_defect(self->order) * missed - forget * self->error[i];
        self->path[i] += steps * turned - forget * self->path[i];
        double error = fmin(self->error[i], HALF_TURN);
        self->is_ample &= !counts(error, self->path[i], AMPLE);
        if (counts(error, self->path[i], 1)) note(self->motion, i, error);
    }
}

int zd_resolution_look_at_turns(zd_resolution *self, double h, int64_t step, int parts)
{
    int status = self->motion->system.quaternions ? zd_turning_evaluate(&self->turning) : ZD_DONE;
    if (!status) add_up_turns(self, h, (double)(step - self->step) * parts);
    self->step = step;
    return status;
}

int zd_resolution_look(zd_resolution *self, double h, int64_t step)
{
    ZD_SIZED(add_up, self->motion->system.nv, self, h, (double)(step - self->step));
    return zd_resolution_look_at_turns(self, h, step, 1);
}
