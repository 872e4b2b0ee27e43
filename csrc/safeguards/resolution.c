/* Resolution of the motion by fixed steps, coordinate by coordinate.
 *
 * The energy balance and omega h are sums over the whole mechanism, to which low-inertia components contribute little. So each coordinate
 * is checked individually: if positions, velocities and accelerations of both ends belong to one smooth motion, Hermite's formula
 *
 *     p1 - p0 = h (v0 + v1) / 2 - h^2 (vdot1 - vdot0) / 12 + O(h^5)
 *
 * holds; its defect estimates the error of the step, with the accuracy of a method of order four. With a kinematic matrix, pdot is not v,
 * and velocities are checked instead of coordinates, by the trapezoidal rule. Each unit quaternion is checked as well, in turning.c.
 *
 * Defects of a coordinate are summed over about a thousand steps, in characteristic scales, with decreasing weight: otherwise every long
 * run would be flagged. The sum is compared with the distance that the coordinate has covered, and bounded by the range in which it moves,
 * which its error cannot exceed. The factors and bounds are those that best separated wrong from right runs in
 * tests/stress/light_parts.py.
 */
#include "safeguards.h"

#include <math.h>

#include "../linalg/small.h"
#include "../step_limits.h"

static const double HALF_TURN = 3.141592653589793;

/* Factor from the defect of Hermite's formula to the error of a step, by the order of the method. */
static double error_by_defect(int order)
{
    return order < 5 ? 1 : 0.2;
}

/* The same for velocities: from the defect of the trapezoidal rule; for methods of order two and three from h^2 (vdot1 - vdot0), since that
 * rule is of order two itself; for methods of order one from h^2 vdot. */
static double error_by_rate(int order)
{
    return order < 2 ? 1.0 / 2 : order < 4 ? 1.0 / 12 : order < 5 ? 1.0 / 20 : 1.0 / 50;
}

zd_resolution zd_resolution_create(zd_arena *arena, zd_motion *motion, int order, const zd_last *last, const double *vdot0,
                                 const double *pdot0, const double *pdot1)
{
    size_t n = motion->system.nv, all = n + (size_t)motion->system.quaternions;
    int by_velocity = (motion->system.provides & ZD_A) != 0;
    return (zd_resolution){
        .motion = motion,
        .last = last,
        .vdot0 = vdot0,
        .by_velocity = by_velocity,
        .order = order,
        .weight = by_velocity ? error_by_rate(order) : error_by_defect(order),
        .error = zd_arena_doubles(arena, all),
        .path = zd_arena_doubles(arena, all),
        .place = zd_arena_doubles(arena, by_velocity ? n : 0),
        .lowest = zd_arena_doubles(arena, n),
        .highest = zd_arena_doubles(arena, n),
        .turning = zd_turning_create(arena, motion, last, vdot0, pdot0, pdot1),
    };
}

/* Defect of coordinate i (or velocity i times h) in the step, in its unit. */
ZD_INLINE double missed(const zd_resolution *self, int i, double h)
{
    const zd_point *point = self->motion->point;
    double before = self->vdot0[i], after = point->vdot[i], v0 = self->last->v[i], v1 = point->v[i];
    if (!self->by_velocity) return point->p[i] - self->last->p[i] - h / 2 * (v0 + v1) + h * h / 12 * (after - before);
    return self->order < 2 ? h * h * after : self->order < 4 ? h * h * (after - before) : h * (v1 - v0 - h / 2 * (before + after));
}

/* Present value of the coordinate; with a kinematic matrix the integral of the velocity, from checked steps, `led` being the newest part. */
ZD_INLINE double locate(const zd_resolution *self, int i, double led)
{
    const zd_point *point = self->motion->point;
    return self->by_velocity ? self->place[i] + led : point->p[i] * point->inverse_unit[i];
}

/* True if an error exceeds both bounds times `share`. */
ZD_INLINE int counts(double error, double path, double share)
{
    return error > share * ZD_NOTED_ERROR && error > share * ZD_ERROR_SHARE * path;
}

static double forgotten(double steps)
{
    return steps > 8 ? steps / 8 * ZD_DECAY : ZD_DECAY;
}

static void note(zd_motion *motion, int i, double error)
{
    zd_statistics *statistics = &motion->statistics;
    if (error > ZD_UNRESOLVED_ERROR && !statistics->unresolved++) statistics->unresolved_time = motion->point->t;
    if (!(error > statistics->part_error)) return;
    statistics->part_error = error;
    statistics->part = i;
}

ZD_INLINE void add_up(const int n, zd_resolution *self, double h, double steps)
{
    const zd_point *point = self->motion->point;
    const double *inverse_unit = point->inverse_unit;
    const int first = self->step == 0;
    const double decay = forgotten(steps);
    int near = 0;
    for (int i = 0; i < n; i++) {
        double led = steps * h / 2 * (self->last->v[i] + point->v[i]) * inverse_unit[i], at = locate(self, i, led);
        self->error[i] += steps * self->weight * fabs(missed(self, i, h)) * inverse_unit[i] - decay * self->error[i];
        self->path[i] += fabs(led) - decay * self->path[i];
        if (self->by_velocity) self->place[i] = at;
        self->lowest[i] = first || at < self->lowest[i] ? at : self->lowest[i];
        self->highest[i] = first || at > self->highest[i] ? at : self->highest[i];
        double range = self->highest[i] - self->lowest[i], error = self->error[i] < range ? self->error[i] : range;
        near |= counts(self->error[i], self->path[i], ZD_AMPLE_RESOLUTION);
        if (counts(error, self->path[i], 1)) note(self->motion, i, error);
    }
    self->is_ample = !near;
}

/* The same for rotations; the error of an attitude cannot exceed half a turn. */
static void add_up_turns(zd_resolution *self, double h, double steps)
{
    const double decay = forgotten(steps);
    for (int k = 0; k < self->motion->system.quaternions; k++) {
        const int i = self->motion->system.nv + k;
        double missed, turned;
        zd_turning_compare(&self->turning, k, h, &missed, &turned);
        self->error[i] += steps * error_by_defect(self->order) * missed - decay * self->error[i];
        self->path[i] += steps * turned - decay * self->path[i];
        double error = fmin(self->error[i], HALF_TURN);
        self->is_ample &= !counts(error, self->path[i], ZD_AMPLE_RESOLUTION);
        if (counts(error, self->path[i], 1)) note(self->motion, i, error);
    }
}

int zd_resolution_check_turns(zd_resolution *self, double h, int64_t step, int parts)
{
    int status = self->motion->system.quaternions ? zd_turning_evaluate(&self->turning) : ZD_DONE;
    if (!status) add_up_turns(self, h, (double)(step - self->step) * parts);
    self->step = step;
    return status;
}

int zd_resolution_check(zd_resolution *self, double h, int64_t step)
{
    ZD_SIZED(add_up, self->motion->system.nv, self, h, (double)(step - self->step));
    return zd_resolution_check_turns(self, h, step, 1);
}
