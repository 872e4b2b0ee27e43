/* Steps in lanes: integration, projection onto the constraints, and acceptance, separately for each lane. */
#include "kernel.h"

/* ---- projection onto the constraints ---- */

/* True if some Phi exceeds its tolerance; *residual: the largest relative to its row's size. */
ZD_KERNEL zd_condition is_open(const zd_lanes *self, zd_real *residual)
{
    zd_condition open = {0};
    *residual = ZD_SPLAT(0.0);
    for (int k = 0; k < self->mh; k++) {
        const zd_real size = size_of(REAL(self->Phi)[k]), share = size * REAL(self->inverse_size)[k];
        open |= ~(size <= REAL(self->allowed)[k]);
        *residual = ZD_WHERE(share <= *residual, *residual, share);
    }
    return open;
}

/* y <- its correction at t, (25) ... (27), in the `wanted` lanes. Returns the lanes in which it does not converge. */
ZD_KERNEL zd_condition correct_state(zd_lanes *self, const double *t, double *y, zd_condition wanted)
{
    double *v = y + self->nq * ZD_LANES;
    zd_condition failed = {0};
    zd_real first = ZD_SPLAT(0.0), count = first, residual;
    for (int iteration = 0;; iteration++) {
        correct(self, t, y, v);
        zd_condition open = is_open(self, &residual) & wanted & ~failed;
        if (iteration == 0) first = residual;
        if (iteration == 1) failed |= open & ~(residual <= ZD_TRUSTED_SHARE * first);
        if (iteration == self->max_iterations) failed |= open;
        open &= ~failed;
        if (!ZD_ANY(open)) break;
        count += AS_NUMBER(open);
        for (int i = 0; i < self->nq; i++) REAL(y)[i] = ZD_WHERE(open, REAL(y)[i] - REAL(self->dp)[i], REAL(y)[i]);
    }
    for (int i = 0; i < self->nv; i++) REAL(v)[i] = ZD_WHERE(wanted, REAL(v)[i] - REAL(self->dv)[i], REAL(v)[i]);
    *REAL(self->iterations) += count;
    *REAL(self->peak_iterations) = LARGER(count, *REAL(self->peak_iterations));
    return failed;
}

/* ---- acceptance of a step ---- */

typedef struct zd_lane_path {
    zd_real moved, detour, speed;       /* sums of squares, characteristic scales */
} zd_lane_path;

/* Rates of p at y, and at the end of the step. */
ZD_KERNEL const double *rates_at(const zd_lanes *self, const double *y, const double *pdot)
{
    return self->has_A ? pdot : y + self->nq * ZD_LANES;
}

ZD_KERNEL zd_lane_path find_path(const zd_lanes *self, zd_real h)
{
    const zd_stored *rate0 = REAL(rates_at(self, self->y, self->pdot));
    const zd_stored *rate1 = REAL(rates_at(self, self->y1, self->pdot1));
    const zd_real half = 0.5 * h;
    zd_lane_path sum = {ZD_SPLAT(0.0), ZD_SPLAT(0.0), ZD_SPLAT(0.0)};
    for (int i = 0; i < self->nq; i++) {
        const zd_real unit = REAL(self->inverse_unit_p)[i], rate = rate1[i] * unit;
        const zd_real moved = (REAL(self->y1)[i] - REAL(self->y)[i]) * unit;
        const zd_real detour = ZD_FNMA(half, ZD_FMA(rate0[i], unit, rate), moved);
        sum.moved = ZD_FMA(moved, moved, sum.moved);
        sum.detour = ZD_FMA(detour, detour, sum.detour);
        sum.speed = ZD_FMA(rate, rate, sum.speed);
    }
    return sum;
}

/* True if the path is within `bound` of h times some mean of the rates at its ends: see guard.c. */
ZD_KERNEL zd_condition is_near(const zd_lanes *self, zd_real h, zd_real bound)
{
    const zd_stored *rate0 = REAL(rates_at(self, self->y, self->pdot));
    const zd_stored *rate1 = REAL(rates_at(self, self->y1, self->pdot1));
    zd_real rest = ZD_SPLAT(0.0), along = rest, turn = rest;
    for (int i = 0; i < self->nq; i++) {
        const zd_real unit = REAL(self->inverse_unit_p)[i];
        const zd_real a = (REAL(self->y1)[i] - REAL(self->y)[i] - h * rate0[i]) * unit, b = h * (rate1[i] - rate0[i]) * unit;
        rest += a * a, along += a * b, turn += b * b;
    }
    zd_real share = ZD_WHERE(turn > 0.0, along / ZD_WHERE(turn > 0.0, turn, 1.0), 0.0);
    share = SMALLER(LARGER(share, 0.0), 1.0);
    return rest - 2 * share * along + share * share * turn <= bound;
}

/* Smallest pivots of constraints and of D^T M D, relative to their scales. */
ZD_KERNEL void smallest(const zd_lanes *self, const zd_elimination *order, const double *scale, const double *pivots,
                                  zd_real *of_rows, zd_real *of_mass)
{
    *of_rows = *of_mass = ZD_SPLAT(INFINITY);
    for (int k = 0; k < order->solves + self->nv - self->m; k++) {
        zd_real *smallest = k < order->solves ? of_rows : of_mass;
        const zd_real pivot = REAL(pivots)[k], share = (k < order->solves ? size_of(pivot) : pivot) * REAL(scale)[k];
        *smallest = ZD_WHERE(share >= *smallest, *smallest, ZD_WHERE(share == share, share, 0.0));
    }
}

/* True if pivots are large enough at the end of a step; *continues: the next step may begin with the first order, which the lane has. */
ZD_KERNEL zd_condition pivots_are_sound(const zd_lanes *self, zd_condition *continues)
{
    zd_condition sound = {0};
    *continues = sound;
    for (int i = 0; i < self->closed_form->orders; i++) {
        const zd_condition has = *REAL(self->order) == (double)i;
        if (!ZD_ANY(has)) continue;
        zd_real of_rows, of_mass;
        smallest(self, self->closed_form->order + i, self->scale + i * self->nv * ZD_LANES, self->pivots1, &of_rows, &of_mass);
        sound |= has & (of_rows >= ZD_SMALL_PIVOT) & (of_mass >= ZD_LARGE_PIVOT);
        if (i == 0) *continues = has & (of_rows >= ZD_LARGE_PIVOT) & (of_mass >= ZD_LARGE_PIVOT);
    }
    for (int k = 0; k < self->nv; k++) {
        const zd_real x = REAL(self->pivots1)[k], x0 = REAL(self->pivots)[k];
        sound &= x * x0 >= ZD_SHRUNK_PIVOT * x0 * x0;
    }
    return sound;
}

/* Counts successive fixed steps beyond the stability limit: omega h from vdot1 - vdot0 = -omega^2 (p1 - p0), as in guard.c. */
ZD_KERNEL void watch_stability(zd_lanes *self, zd_real h, zd_real moved)
{
    zd_real changed = ZD_SPLAT(0.0);
    for (int i = 0; i < self->nv; i++) {
        const zd_real x = (REAL(self->vdot1)[i] - REAL(self->vdot)[i]) * REAL(self->inverse_unit)[i];
        changed = ZD_FMA(x, x, changed);
    }
    const zd_real square = h * h, streak = *REAL(self->streak) + 1.0;
    *REAL(self->streak) = ZD_WHERE(square * square * changed > self->limit * moved, streak, 0.0);
}

/* True if the step to y1 is accepted; else the run has to be made individually. */
ZD_KERNEL zd_condition is_accepted(zd_lanes *self, zd_real h, zd_real *speed, zd_condition *continues)
{
    const zd_lane_path path = find_path(self, h);
    *speed = path.speed;
    const zd_condition is_short = path.moved <= ZD_FAR_PATH * ZD_FAR_PATH;
    const zd_condition is_calm = (ZD_CALM_DETOUR * ZD_CALM_DETOUR * path.detour <= path.moved + self->nearby)
                               & (path.speed <= ZD_FASTER_SPEED * *REAL(self->fastest) + self->nearby);
    *REAL(self->check_soon) = ZD_WHERE(is_calm, *REAL(self->check_soon), 1.0);
    zd_condition accepted = pivots_are_sound(self, continues) & is_short;
    if (self->mh && self->corrects) {
        const zd_real bound = ZD_FMA(self->astray * h * h, *REAL(self->speed) + path.speed, self->nearby);
        zd_condition near = path.detour <= bound;
        if (ZD_ANY(~near)) near |= is_near(self, h, bound);
        accepted &= near;
        *REAL(self->is_long) = AS_NUMBER(path.moved > ZD_LONG_PATH * ZD_LONG_PATH);
    }
    if (self->is_fixed) {
        watch_stability(self, h, path.moved);
        accepted &= *REAL(self->streak) < (double)ZD_UNSTABLE_STREAK;
    }
    return accepted & (path.moved == path.moved);
}

/* ---- order of elimination ---- */

/* Selects order i in the lanes that have none, if its pivots are large enough. */
ZD_KERNEL void try_order(zd_lanes *self, int i, double enough)
{
    const zd_elimination *order = self->closed_form->order + i;
    const zd_lane_rates to = {self->pdot1, self->vdot1, NULL, self->has_input ? self->power1 : NULL, self->pivots1};
    zd_real of_rows, of_mass;
    call(self, order, self->t, self->y, self->y + self->nq * ZD_LANES, &to);
    smallest(self, order, self->scale + i * self->nv * ZD_LANES, self->pivots1, &of_rows, &of_mass);
    const zd_real has = *REAL(self->order);
    const zd_condition takes = (has != has) & (of_rows >= enough) & (of_mass >= ZD_LARGE_PIVOT);
    *REAL(self->order) = ZD_WHERE(takes, (double)i, has);
    take_rates_where(takes, self);
}

/* Selects the first order whose pivots are large, or else sufficient; if there is none the run leaves. Updates the speed. */
ZD_KERNEL void choose(zd_lanes *self)
{
    for (int pass = 0; pass < 2; pass++)
        for (int i = 0; i < self->closed_form->orders; i++)
            if (ZD_ANY(*REAL(self->order) != *REAL(self->order))) try_order(self, i, pass ? ZD_SUFFICIENT_PIVOT : ZD_LARGE_PIVOT);
    const zd_real order = *REAL(self->order);
    const zd_condition has_none = order != order;
    *REAL(self->leaves) = ZD_WHERE(has_none & HOLDS(self->is_active), 1.0, *REAL(self->leaves));
    *REAL(self->order) = ZD_WHERE(has_none, 0.0, order);
    const zd_stored *rate = REAL(rates_at(self, self->y, self->pdot));
    zd_real speed = ZD_SPLAT(0.0);
    for (int i = 0; i < self->nq; i++) {
        const zd_real x = rate[i] * REAL(self->inverse_unit_p)[i];
        speed = ZD_FMA(x, x, speed);
    }
    *REAL(self->speed) = speed;
}

ZD_KERNEL void renew(zd_lanes *self)
{
    const zd_lane_rates to = {self->pdot, self->vdot, NULL, self->has_input ? self->power : NULL, self->pivots};
    accelerate(self, self->t, self->y, self->y + self->nq * ZD_LANES, &to);
}

/* ---- step-size control ---- */

/* 1 / x^(1 / k) for x between 2^-40 and 2^40: Halley's iteration from a guess by the bits of x, which are nearly its logarithm */
ZD_KERNEL zd_real inverse_root(zd_real x, int k)
{
    const zd_real magic = ZD_SPLAT(0x1p52);
    typedef uint64_t words __attribute__((vector_size(8 * ZD_LANES)));
    const zd_real exponent = (zd_real)(((words)x >> 32) | (words)magic) - magic;     /* the upper half as a number */
    const zd_real guess = 1072693248.0 - (exponent - 1072693248.0) / (double)k;     /* that of 1 is 0x3ff00000 */
    zd_real y = (zd_real)((words)(guess + magic) << 32);
    for (int i = 0; i < 4; i++) {
        zd_real power = x;
        for (int j = 0; j < k; j++) power *= y;
        y *= ((k - 1) * power + (k + 1)) / ((k + 1) * power + (k - 1));
    }
    return y;
}

/* Sum of squares of sum_j weight_j k_j relative to the tolerances. */
ZD_KERNEL zd_real squares(const zd_lanes *self, const zd_weights *weights)
{
    zd_real squares = ZD_SPLAT(0.0);
    combine(self, weights, ZD_SPLAT(1.0), NULL, self->other);
    for (int i = 0; i < self->size; i++) {
        const zd_real x = REAL(self->other)[i] / REAL(self->tolerated)[i];
        squares = ZD_FMA(x, x, squares);
    }
    return squares;
}

/* Counts steps at the stability limit, as in adaptive.c, in these lanes: by |lambda h|, see runge_kutta.c. */
ZD_KERNEL void watch_stiffness(zd_lanes *self, zd_condition checks, zd_real h)
{
    const int size = self->size, stages = self->method.stages;
    const zd_stored *of_stage = REAL(self->k) + (stages - 1) * size, *of_y = of_stage + size;
    zd_real rates = ZD_SPLAT(0.0), states = rates, rounding = rates;
    for (int i = 0; i < size; i++) {
        const zd_real unit = 1.0 / REAL(self->tolerated)[i], rate = (of_y[i] - of_stage[i]) * unit;
        const zd_real state = (REAL(self->y1)[i] - REAL(self->stage)[i]) * unit, least = ZD_STATE_ROUNDING * REAL(self->y1)[i] * unit;
        rates = ZD_FMA(rate, rate, rates);
        states = ZD_FMA(state, state, states);
        rounding = ZD_FMA(least, least, rounding);
    }
    const zd_condition known = checks & (states > rounding) & (rates > 0.0);
    const zd_condition is_long = known & (h * h * rates > ZD_STABILITY_LIMIT * ZD_STABILITY_LIMIT * self->decay * self->decay * states);
    const zd_real below = ZD_WHERE(is_long, 0.0, *REAL(self->below_limit) + AS_NUMBER(known));
    const zd_condition is_calm = known & ~is_long & (below >= (double)ZD_NOT_STIFF_AFTER);
    const zd_real at = ZD_WHERE(is_calm, 0.0, *REAL(self->at_limit) + AS_NUMBER(is_long));
    *REAL(self->below_limit) = below;
    *REAL(self->at_limit) = at;
    const zd_real more = ZD_WHERE(at == (double)ZD_STIFF_AFTER, at, ZD_WHERE(at > (double)ZD_STIFF_AFTER, 1.0, 0.0));
    *REAL(self->stiff) += ZD_WHERE(is_long, more, 0.0);
}

/* Lanes in which stiffness is checked: if that takes an evaluation, every ZD_CHECK_STIFFNESS_EVERY steps. */
ZD_KERNEL zd_condition checks_stiffness(const zd_lanes *self)
{
    const zd_method *method = &self->method;
    const zd_condition none = {0};
    if (method->tableau->c[method->stages - 1] != 1) return none;
    if (method->tableau->e[method->stages] != 0) return ~none;
    return is_multiple(*REAL(self->number) + *REAL(self->rejected) + 1.0, ZD_CHECK_STIFFNESS_EVERY);
}

/* Error of the step to y1, root mean square relative to the tolerances: see runge_kutta.h. */
ZD_KERNEL zd_real error(zd_lanes *self, const double *t1, zd_real h)
{
    const zd_method *method = &self->method;
    const zd_condition checks = checks_stiffness(self) & HOLDS(self->is_active);
    const int is_checking = ZD_ANY(checks);
    if (method->tableau->e[method->stages] != 0 || is_checking)
        rate(self, t1, self->y1, self->k + method->stages * self->size * ZD_LANES);
    for (int i = 0; i < self->size; i++) {
        const zd_real a = size_of(REAL(self->y)[i]), b = size_of(REAL(self->y1)[i]);
        REAL(self->tolerated)[i] = ZD_FMA(LARGER(a, b), self->rtol, self->atol);
    }
    const zd_real sum = squares(self, &method->e);
    const zd_real blend = method->tableau->e3 ? sum + 0.01 * squares(self, &method->e3) : sum;
    const zd_condition is_zero = sum == 0.0;
    const zd_real norm = ZD_WHERE(is_zero, 0.0,
                                  size_of(h) * sum / ZD_SQRT(ZD_WHERE(is_zero, 1.0, blend) * (double)self->size));
    if (is_checking) watch_stiffness(self, checks & (norm <= 1.0), h);
    return norm;
}

ZD_KERNEL zd_real size_factor(const zd_lanes *self, zd_real norm)
{
    const zd_real bounded = SMALLER(LARGER(norm, 0x1p-40), 0x1p40);
    const zd_real wanted = ZD_SAFETY * inverse_root(bounded, self->method.error_order + 1);
    return SMALLER(LARGER(wanted, ZD_MIN_FACTOR), ZD_MAX_FACTOR);
}
