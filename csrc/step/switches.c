/* Switches: comparisons of the motion at which a force jumps. An attempt within which some of them change is made again with these as they
 * are at its start, so that all its stages are on one side; the instant at which the first of them changes is located by attempts of other
 * sizes, and the step ends there. The next step has that comparison as it is after the change, however the difference of its sides is
 * rounded at its start, and is short, as a change back within it would not be seen. In all other steps the comparisons decide.
 *
 * A comparison that changes back at the instant at which it changed is met from both sides, as by dry friction at rest.
 */
#include "step_loop.h"

#include <float.h>
#include <math.h>

#include "../linalg/small.h"
#include "../step_limits.h"

static const double SHORT_STEP = 0x1p-6;        /* size of the step after a change, relative to that in which it was found */
static const double SHARE_OF_STEP = 0x1p-10;    /* accuracy of an instant relative to the step, in units of rtol */
static const double SMALL_CHANGE = 0x1p-20;     /* change of coordinates by which rates are found */
static const double MIN_RATE = 1e-3;            /* ratio of the smaller rate to the larger one, at which both sides lead to a jump */
static const double MIN_VALUE = 0.25;           /* ratio of a minimum to the values at the ends, below which a step ends there */
static const double MIN_SHARE = 0x1p-20;        /* distance of a minimum from the ends, relative to the step */
static const double CHANGE_TOLERANCE = 0x1p6;   /* difference at a change relative to the largest one at samples, in units of rtol */
static const double HELD_SIDE = 1, CHANGED_SIDE = 2;    /* |side|: the sign at the start of the step; that after a change at its start */

zd_switching zd_switching_create(zd_arena *arena, const zd_motion *motion)
{
    const zd_switches *switches = motion->system.switches;
    const int count = switches ? switches->count : 0;
    return (zd_switching){
        .count = count,
        .side = zd_arena_doubles(arena, count), .written = zd_arena_doubles(arena, count),
        .before = zd_arena_doubles(arena, count), .now = zd_arena_doubles(arena, count),
        .rate_before = zd_arena_doubles(arena, count), .rate_now = zd_arena_doubles(arena, count),
        .ahead = count ? zd_state_create(arena, motion) : (zd_state){0},
        .at_a = zd_arena_doubles(arena, count),
        .largest = zd_arena_doubles(arena, count),
        .sought = -1, .t_before = NAN,
    };
}

static void evaluate(const zd_step_loop *loop, double t, const double *p, const double *v, double *value)
{
    const zd_system *system = &loop->motion->system;
    system->switches->evaluate(system->data, t, p, v, value, loop->motion->point->terms.scratch);
}

static void evaluate_now(const zd_step_loop *loop, double *value)
{
    evaluate(loop, loop->stepper->t, loop->motion->point->p, loop->motion->point->v, value);
}

/* now, rate (count,) <- differences at the point, and their rates by a small change, 0 where they cannot be found. The scratch memory is at
 * the point afterwards, for terms that are evaluated there later. */
static void find_rates(const zd_step_loop *loop, double *now, double *rate)
{
    const zd_switching *self = &loop->switching;
    zd_point *point = loop->motion->point;
    const int nq = point->system->nq, nv = point->system->nv, known = point->known;
    double *p = self->ahead.p, *v = self->ahead.v;
    zd_clear(self->count, rate);
    const int status = zd_stepper_rates(loop->stepper, p, v);
    point->known = known;
    const double s = status ? 0 : SMALL_CHANGE / fmax(1, fmax(zd_max_abs(nq, p), zd_max_abs(nv, v)));
    for (int i = 0; s > 0 && i < nq; i++) p[i] = point->p[i] + s * p[i];
    for (int i = 0; s > 0 && i < nv; i++) v[i] = point->v[i] + s * v[i];
    if (s > 0) evaluate(loop, loop->stepper->t + s, p, v, rate);
    evaluate_now(loop, now);
    for (int i = 0; s > 0 && i < self->count; i++) rate[i] = (rate[i] - now[i]) / s;
}

static int have_different_signs(double a, double b) { return a > 0 ? b < 0 : a < 0 && b > 0; }

/* True if values have the other sign than a switch is held at. */
static int has_passed(const zd_switching *self, int i, const double *value) { return have_different_signs(self->side[i], value[i]); }

/* Writes the sides to their places; true if one is new. */
static int write_sides(zd_step_loop *loop)
{
    zd_switching *self = &loop->switching;
    int is_new = self->holds = 0;
    for (int i = 0; i < self->count; i++) {
        is_new |= self->written[i] != self->side[i];
        self->written[i] = *loop->motion->system.switches->place[i] = self->side[i];
        self->holds |= self->side[i] != 0;
    }
    return is_new;
}

void zd_switching_release(zd_step_loop *loop)
{
    loop->switching.sought = -1;
    loop->switching.t_before = NAN;
    zd_clear(loop->switching.count, loop->switching.side);
}

int zd_switching_begin(zd_step_loop *loop)
{
    zd_switching *self = &loop->switching;
    self->sought = -1;
    self->is_released = self->is_cut = self->is_shortened = 0;
    if (self->t_before != loop->stepper->t) zd_clear(self->count, self->side);      /* as an event within the step ended it */
    int status = write_sides(loop) ? zd_renew(loop) : ZD_DONE;
    if (!status && self->t_before != loop->stepper->t) find_rates(loop, self->before, self->rate_before);
    if (status || !self->holds) return status;
    return zd_closed_form_leave(loop->motion) ? zd_safeguards_begin(loop->safeguards, loop->step) : ZD_DONE;
}

void zd_switching_compare(zd_step_loop *loop, double t, const double *p, const double *v)
{
    zd_switching *self = &loop->switching;
    zd_copy_all(self->count, self->now, self->before);
    evaluate(loop, t, p, v, self->now);
    for (int i = 0; i < self->count; i++) self->largest[i] = fmax(self->largest[i], fabs(self->now[i]));
}

int zd_switching_hold_between(zd_step_loop *loop)
{
    zd_switching *self = &loop->switching;
    for (int i = 0; i < self->count; i++) {
        const double a = self->before[i], b = self->now[i], tolerance = CHANGE_TOLERANCE * loop->settings->rtol * self->largest[i];
        self->side[i] = fmin(fabs(a), fabs(b)) <= tolerance ? copysign(HELD_SIDE, fabs(a) > fabs(b) ? a : b) : 0;
    }
    write_sides(loop);
    return self->holds;
}

void zd_switching_turn(zd_step_loop *loop)
{
    for (int i = 0; i < loop->switching.count; i++) loop->switching.side[i] = -loop->switching.side[i];
    write_sides(loop);
}

static int return_to_start(zd_step_loop *loop)
{
    zd_stepper *stepper = loop->stepper;
    if (stepper->integrator->forget) stepper->integrator->forget(stepper->memory);
    const int status = zd_stepper_return(stepper);
    return status ? status : zd_safeguards_begin(loop->safeguards, loop->step);
}

/* Accuracy of an instant between t0 and t1, in s */
static double resolution_of(const zd_step_loop *loop, double t0, double t1)
{
    return fmax(ZD_TIME_RESOLUTION * fmax(fabs(t0), fabs(t1)), SHARE_OF_STEP * loop->settings->rtol * (t1 - t0));
}

/* Holds the switches that change within an attempt, for another; false if there are none. A change where it begins has been made already. */
static int hold(zd_step_loop *loop, int *status)
{
    zd_switching *self = &loop->switching;
    const double t0 = loop->stepper->last.t, resolution = 2 * resolution_of(loop, t0, t0 + loop->control.bounded);
    for (int i = 0; i < self->count; i++) {
        const double a = self->before[i], b = self->now[i], rate = self->rate_before[i];
        if (have_different_signs(a, b)) self->side[i] = copysign(HELD_SIDE, fabs(a) <= fabs(rate) * resolution ? rate : a);
    }
    if (!write_sides(loop)) return 0;
    loop->motion->statistics.rejected++;
    zd_closed_form_leave_step(loop->motion);
    *status = return_to_start(loop);
    return !*status;
}

/* Begins the search for the change of a switch between the start of the step, and t with these values. */
static void seek(zd_step_loop *loop, int i, double t, const double *value)
{
    zd_switching *self = &loop->switching;
    const double t0 = loop->stepper->last.t;
    const double at_start = copysign(fmax(fabs(self->before[i]), DBL_MIN), self->side[i]);
    self->sought = i;
    self->bracket = zd_bracket_of(t0, t, at_start, value[i], resolution_of(loop, t0, t));
    zd_copy_all(self->count, self->before, self->at_a);
}

/* The switch that passes first by linear interpolation; -1: none. */
static int first_of(const zd_switching *self)
{
    int first = -1;
    double smallest = INFINITY;
    for (int i = 0; i < self->count; i++) {
        const double share = self->before[i] / (self->before[i] - self->now[i]);
        if (!has_passed(self, i, self->now) || !(share < smallest || first < 0)) continue;
        first = i;
        smallest = share;
    }
    return first;
}

/* A switch that has passed before the one that was located; -1: none. */
static int earlier_of(const zd_switching *self)
{
    for (int i = 0; i < self->count; i++)
        if (i != self->sought && has_passed(self, i, self->at_a)) return i;
    return -1;
}

/* ZD_COLLAPSED at a jump to which both sides lead, with the velocity whose rate jumps most. */
static int meet_from_both_sides(zd_step_loop *loop)
{
    zd_motion *motion = loop->motion;
    zd_collapse *collapse = &loop->control.collapse;
    zd_switching *self = &loop->switching;
    double *side = &self->side[self->sought];
    find_rates(loop, self->now, self->rate_before);
    zd_copy_all(motion->system.nv, motion->point->vdot, collapse->rate);
    *side = -*side;
    write_sides(loop);
    motion->point->known &= motion->point->constant;
    find_rates(loop, self->now, self->rate_now);
    /* Negative: towards the jump, on this side and on the one before */
    const double rate = self->rate_now[self->sought] * *side, before = -self->rate_before[self->sought] * *side;
    if (!(fmax(rate, before) < MIN_RATE * fmin(rate, before))) return ZD_DONE;
    for (int i = 0; i < motion->system.nv; i++)
        collapse->change[i] = fabs(motion->point->vdot[i] - collapse->rate[i]) * motion->point->inverse_unit[i];
    collapse->count = 0;
    motion->statistics.part = zd_collapse_velocity(collapse, motion->system.nv);
    return ZD_COLLAPSED;
}

/* True of the step after a change. */
static int is_short(const zd_switching *self)
{
    for (int i = 0; i < self->count; i++)
        if (fabs(self->side[i]) == CHANGED_SIDE) return 1;
    return 0;
}

/* Ends the step at the change that was located: the next one has the other sides. */
static int change(zd_step_loop *loop)
{
    zd_switching *self = &loop->switching;
    const int is_met_again = fabs(self->side[self->sought]) == CHANGED_SIDE
        && self->bracket.b - loop->stepper->last.t <= 2 * self->bracket.resolution;
    const int status = is_met_again && loop->control.collapse.share > 0 ? meet_from_both_sides(loop) : ZD_DONE;
    if (status) return status;
    for (int i = 0; i < self->count; i++)
        self->side[i] = !is_met_again && (i == self->sought || has_passed(self, i, self->now)) ? copysign(CHANGED_SIDE, -self->side[i]) : 0;
    self->sought = -1;
    self->is_cut = 1;
    loop->control.h = is_met_again ? self->h : SHORT_STEP * self->h;
    loop->control.stiffness = (zd_stiffness){0};
    return ZD_DONE;
}

/* Lets the comparisons decide after a step without a change; the next one is as long as before the last change. */
static void end_hold(zd_step_loop *loop)
{
    zd_switching *self = &loop->switching;
    self->is_cut = is_short(self);
    if (self->is_cut) loop->control.h = self->h;
    zd_switching_release(loop);
}

/* Share of the step after which a cubic polynomial with these values, of one sign, and slopes at its ends is nearest to zero or has passed
 * it; 1: there is none. */
static double minimum_of(double a, double slope_a, double b, double slope_b)
{
    const double cubic = slope_a + slope_b - 2 * (b - a), square = 3 * (b - a) - 2 * slope_a - slope_b;
    const double root = square * square - 3 * cubic * slope_a, q = -(square + copysign(sqrt(fmax(root, 0)), square));
    const double at[] = {q / (3 * cubic), slope_a / q};
    double found = 1, minimum = MIN_VALUE * fmin(fabs(a), fabs(b));
    for (int k = 0; root > 0 && k < 2; k++) {
        const double x = at[k], value = copysign(1, a) * (((cubic * x + square) * x + slope_a) * x + a);
        if (!(x > MIN_SHARE && x < 1 - MIN_SHARE && value < minimum)) continue;
        found = x;
        minimum = value;
    }
    return found;
}

/* Shortens a step within which a switch may change twice, to the minimum of its difference; true if another attempt follows. */
static int shorten(zd_step_loop *loop, int *status)
{
    zd_switching *self = &loop->switching;
    const double h = loop->stepper->t - loop->stepper->last.t;
    double share = 1;
    find_rates(loop, self->now, self->rate_now);
    for (int i = 0; i < self->count; i++)
        share = fmin(share, minimum_of(self->before[i], h * self->rate_before[i], self->now[i], h * self->rate_now[i]));
    if (share == 1 || self->is_shortened || is_short(self)) return 0;
    self->is_shortened = 1;
    loop->control.h = share * h;
    loop->motion->statistics.rejected++;
    *status = return_to_start(loop);
    return !*status;
}

/* After an accepted attempt with switches held; true if another follows, whose size is set. */
static int goes_on(zd_step_loop *loop, int *status)
{
    zd_switching *self = &loop->switching;
    zd_bracket *it = &self->bracket;
    const double t = loop->stepper->t;
    if (self->sought < 0) {
        const int first = first_of(self);
        if (first < 0) {
            if (shorten(loop, status)) return 1;
            end_hold(loop);
            return 0;
        }
        if (!is_short(self)) self->h = loop->control.bounded;
        seek(loop, first, t, self->now);
    } else {
        if (!has_passed(self, self->sought, self->now)) zd_copy_all(self->count, self->now, self->at_a);
        zd_bracket_narrow(it, t, self->now[self->sought]);
    }
    int is_located = it->b - it->a <= it->resolution;
    const int earlier = is_located ? earlier_of(self) : -1;
    if (earlier >= 0) {
        seek(loop, earlier, it->a, self->at_a);
        is_located = 0;
    }
    if (is_located && (has_passed(self, self->sought, self->now) || t >= it->b)) {
        *status = change(loop);
        return 0;
    }
    loop->control.h = (is_located ? it->b : zd_bracket_choose(it)) - loop->stepper->last.t;
    *status = return_to_start(loop);
    return !*status;
}

static void keep_differences(zd_step_loop *loop)
{
    zd_switching *self = &loop->switching;
    self->t_before = loop->stepper->t;
    zd_copy_all(self->count, self->now, self->before);
    zd_copy_all(self->count, self->rate_now, self->rate_before);
}

int zd_switching_repeats(zd_step_loop *loop, int *status)
{
    zd_switching *self = &loop->switching;
    const int is_accepted = !*status && zd_control_accepts(&loop->control), is_held = self->holds;
    if (*status) {      /* which may be beyond the domain of the side that is held */
        zd_switching_release(loop);
        write_sides(loop);
        self->is_released = 1;
        evaluate(loop, loop->stepper->last.t, loop->stepper->last.p, loop->stepper->last.v, self->before);
        return 0;
    }
    if (!is_accepted) {
        self->sought = -1;
        if (is_held || zd_path_unpack(loop->stepper, loop->stepper->last.t + loop->control.bounded)) return 0;
    }
    evaluate_now(loop, self->now);
    if (is_held ? goes_on(loop, status) : !self->is_released && hold(loop, status)) return 1;
    if (!is_accepted || *status) return 0;
    if (!is_held && shorten(loop, status)) return 1;
    keep_differences(loop);
    return 0;
}
