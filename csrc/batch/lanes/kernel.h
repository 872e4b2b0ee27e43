/* Source for the lanes of each vector unit, included with ZD_UNIT and ZD_LANES: see zerodrift/lanes.h. The results of a lane do not
 * depend on the other lanes.
 */
#include "../../include/zerodrift/lanes.h"
#include "../../step_limits.h"
#include "numbers.h"

#define REAL(pointer) ((zd_stored *)(pointer))
#define HOLDS(pointer) (*REAL(pointer) != 0)        /* a condition stored as a number */
#define AS_NUMBER(condition) ZD_WHERE(condition, 1.0, 0.0)
#define LARGER(a, b) ZD_WHERE((a) > (b), a, b)
#define SMALLER(a, b) ZD_WHERE((a) < (b), a, b)
#define ZD_KERNEL ZD_ON_UNIT static
#define ZD_SUMS 6       /* adjacent sums, whose fused multiply-adds overlap in time */

ZD_KERNEL zd_real size_of(zd_real x)
{
    return ZD_WHERE(x < 0.0, -x, x);
}

ZD_KERNEL void take_where(zd_condition condition, int n, const double *from, double *to)
{
    for (int i = 0; i < n; i++) REAL(to)[i] = ZD_WHERE(condition, REAL(from)[i], REAL(to)[i]);
}

/* Takes rates and pivots at the end of the step, or of another order, to its start. */
ZD_KERNEL void take_rates_where(zd_condition condition, const zd_lanes *self)
{
    take_where(condition, self->has_A ? self->nq : 0, self->pdot1, self->pdot);
    take_where(condition, self->nv, self->vdot1, self->vdot);
    take_where(condition, self->nv, self->pivots1, self->pivots);
    if (self->has_input) take_where(condition, 1, self->power1, self->power);
}

/* True if a number of steps is a multiple of another. */
ZD_KERNEL zd_condition is_multiple(zd_real number, double of)
{
    const zd_real magic = ZD_SPLAT(0x1p52), share = number / of;
    return (share + magic) - magic == share;
}

/* ---- sums over stages ---- */

/* Summands of a sum over stages: rates and weights. */
typedef struct zd_summands {
    int count;
    const zd_stored *k[ZD_MAX_STAGES];
    zd_real factor[ZD_MAX_STAGES];
} zd_summands;

/* n adjacent sums, of the numbers from i on; with constant n they stay in registers. `fused`: products are not rounded. */
ZD_ON_UNIT ZD_SINES_INLINE void add(const int n, const int fused, const zd_summands *of, int i, const zd_stored *from,
                                              zd_stored *to)
{
    zd_real sum[ZD_SUMS];
    for (int j = 0; j < n; j++) sum[j] = from ? (zd_real)from[i + j] : ZD_SPLAT(0.0);
    for (int term = 0; term < of->count; term++) {
        const zd_stored *k = of->k[term] + i;
        const zd_real factor = of->factor[term];
        for (int j = 0; j < n; j++) sum[j] = fused ? ZD_FMA(factor, k[j], sum[j]) : sum[j] + factor * k[j];
    }
    for (int j = 0; j < n; j++) to[i + j] = sum[j];
}

/* to <- from + h sum_j weight_j k_j; from NULL: 0 */
ZD_KERNEL void combine(const zd_lanes *self, const zd_weights *w, zd_real h, const double *from, double *to)
{
    const int size = self->size;
    zd_summands of;
    of.count = w->count;
    for (int j = 0; j < w->count; j++) {
        of.k[j] = REAL(self->k) + w->stage[j] * size;
        of.factor[j] = h * w->weight[j];
    }
    int i = 0;
    if (self->rounds_products) {
        for (; i + ZD_SUMS <= size; i += ZD_SUMS) add(ZD_SUMS, 0, &of, i, REAL(from), REAL(to));
        for (; i < size; i++) add(1, 0, &of, i, REAL(from), REAL(to));
    }
    for (; i + ZD_SUMS <= size; i += ZD_SUMS) add(ZD_SUMS, 1, &of, i, REAL(from), REAL(to));
    for (; i < size; i++) add(1, 1, &of, i, REAL(from), REAL(to));
}

/* ---- closed-form functions ---- */

/* Results of the closed-form functions. */
typedef struct zd_lane_rates {
    double *pdot, *vdot, *lambda, *power, *pivots;      /* the last three NULL: not required */
} zd_lane_rates;

ZD_KERNEL void fill_pivots(const zd_lanes *self, const zd_elimination *order, double *pivots)
{
    for (int k = order->solves + self->nv - self->m; pivots && k < self->nv; k++) REAL(pivots)[k] = ZD_SPLAT(1.0);
}

ZD_KERNEL void call(const zd_lanes *self, const zd_elimination *order, const double *t, const double *p, const double *v,
                              const zd_lane_rates *to)
{
    /* Lanes in which the function fails get NAN, which fails every comparison. */
    const int unknown = order->accelerate(order, self->data, self->inputs, t, p, v, NULL, to->pdot, to->vdot, to->lambda, to->power,
                                          to->pivots);
    fill_pivots(self, order, to->pivots);
    for (int lane = 0; unknown && lane < ZD_LANES; lane++)
        if (unknown >> lane & 1) to->vdot[lane] = NAN;
}

/* Order of elimination common to all lanes; -1: they differ. */
ZD_KERNEL int common_order(const zd_lanes *self)
{
    const double first = self->order[0];
    if (self->closed_form->orders == 1) return 0;
    return ZD_ANY(*REAL(self->order) != first) ? -1 : (int)first;
}

ZD_KERNEL void accelerate(const zd_lanes *self, const double *t, const double *p, const double *v, const zd_lane_rates *to)
{
    const int common = common_order(self), nq = self->nq, nv = self->nv, m = self->m;
    if (common >= 0) {
        call(self, self->closed_form->order + common, t, p, v, to);
        return;
    }
    double *other = self->other;
    const zd_lane_rates there = {other, other + nq * ZD_LANES, to->lambda ? other + (nq + nv) * ZD_LANES : NULL,
                                   to->power ? other + (nq + nv + m) * ZD_LANES : NULL,
                                   to->pivots ? other + (nq + nv + m + 1) * ZD_LANES : NULL};
    for (int i = 0; i < self->closed_form->orders; i++) {
        const zd_condition has = *REAL(self->order) == (double)i;
        if (!ZD_ANY(has)) continue;
        call(self, self->closed_form->order + i, t, p, v, &there);
        take_where(has, self->has_A ? nq : 0, there.pdot, to->pdot);
        take_where(has, nv, there.vdot, to->vdot);
        take_where(has, to->lambda ? m : 0, there.lambda, to->lambda);
        take_where(has, to->power != NULL, there.power, to->power);
        take_where(has, to->pivots ? nv : 0, there.pivots, to->pivots);
    }
}

/* Phi, dp and dv at (t, p, v), with the order of elimination at the start of the step. */
ZD_KERNEL void correct(const zd_lanes *self, const double *t, const double *p, const double *v)
{
    const int common = common_order(self);
    const zd_elimination *order = self->closed_form->order;
    if (common >= 0) {
        order[common].correct(order + common, self->data, self->inputs, t, p, v, self->Phi, self->dp, self->dv);
        return;
    }
    double *dp = self->other, *dv = dp + self->nq * ZD_LANES;
    for (int i = 0; i < self->closed_form->orders; i++) {
        const zd_condition has = *REAL(self->order) == (double)i;
        if (!ZD_ANY(has)) continue;
        order[i].correct(order + i, self->data, self->inputs, t, p, v, self->Phi, dp, dv);
        take_where(has, self->nq, dp, self->dp);
        take_where(has, self->nv, dv, self->dv);
    }
}

/* Rates of the state, written to a stage `rates` of the method. */
ZD_KERNEL void rate(const zd_lanes *self, const double *t, const double *y, double *rates)
{
    const double *v = y + self->nq * ZD_LANES;
    const zd_lane_rates to = {rates, rates + self->nq * ZD_LANES, NULL, self->has_input ? rates + (self->size - 1) * ZD_LANES : NULL, NULL};
    if (!self->has_A)
        for (int i = 0; i < self->nv; i++) REAL(rates)[i] = REAL(v)[i];
    accelerate(self, t, y, v, &to);
}
