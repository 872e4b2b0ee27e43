/* Step loop in all lanes at once, until one of them requires attention; and states within a step. */
#include "checks.h"

/* y1 from y, by the method's stages */
ZD_KERNEL void integrate(const zd_lanes *self, const double *from, zd_real t, zd_real h, double *to)
{
    const zd_method *method = &self->method;
    const int size = self->size;
    zd_stored at_stage;
    for (int i = 1; i < method->stages; i++) {
        double *rates = self->k + i * size * ZD_LANES;
        at_stage = t + method->tableau->c[i] * h;
        combine(self, &method->a[i], h, from, self->stage);
        rate(self, (const double *)&at_stage, self->stage, rates);
    }
    combine(self, &method->b, h, from, to);
}

/* Sets the first stage from the rates at the start of the step. */
ZD_KERNEL void begin(const zd_lanes *self)
{
    const int nq = self->nq, nv = self->nv;
    const zd_stored *rate = REAL(rates_at(self, self->y, self->pdot));
    for (int i = 0; i < nq; i++) REAL(self->k)[i] = rate[i];
    for (int i = 0; i < nv; i++) REAL(self->k)[nq + i] = REAL(self->vdot)[i];
    if (self->has_input) REAL(self->k)[nq + nv] = *REAL(self->power);
}

/* Time at the end of the step, and *h its size. */
ZD_KERNEL zd_real end_of_step(const zd_lanes *self, zd_real *h)
{
    const zd_real t = *REAL(self->t), end = ZD_SPLAT(self->end);
    if (self->is_fixed) {
        const zd_real number = *REAL(self->number) + 1.0;
        const zd_condition is_last = number == self->steps;
        const zd_real t1 = ZD_WHERE(is_last, end, self->t0 + number * self->step);
        const double rounding = ZD_TIME_RESOLUTION * fmax(fabs(self->t0), fabs(self->end));
        *h = ZD_WHERE(size_of(t1 - t - self->step) > rounding, t1 - t, self->step);    /* shorter: the last, and after an event */
        return t1;
    }
    zd_real size = *REAL(self->h);
    size = SMALLER(SMALLER(size, self->longest), end - t);
    const zd_real t1 = ZD_WHERE(size == end - t, end, t + size);
    *h = t1 - t;
    return t1;
}

/* Sets the state to y1 in lanes whose step was accepted, and stores its start. */
ZD_KERNEL void keep(zd_lanes *self, zd_condition accepted, zd_real t1, zd_real speed, zd_condition continues)
{
    *REAL(self->t_before) = ZD_WHERE(accepted, *REAL(self->t), *REAL(self->t_before));
    take_where(accepted, self->size, self->y, self->y0);
    take_where(accepted, self->size, self->y1, self->y);
    take_rates_where(accepted, self);
    *REAL(self->speed) = ZD_WHERE(accepted, speed, *REAL(self->speed));
    *REAL(self->t) = ZD_WHERE(accepted, t1, *REAL(self->t));
    *REAL(self->number) += AS_NUMBER(accepted);
    *REAL(self->order) = ZD_WHERE(accepted & ~continues, NAN, *REAL(self->order));
}

/* Size of the next step, from the error of this one; returns the lanes that accept it. */
ZD_KERNEL zd_condition control(zd_lanes *self, zd_real h, zd_real norm)
{
    const zd_condition active = HOLDS(self->is_active), accepted = norm <= 1.0;
    const zd_real factor = size_factor(self, norm);
    const zd_real bounded = ZD_WHERE(accepted & HOLDS(self->after_rejection) & (factor > 1.0), 1.0, factor);
    *REAL(self->h) = ZD_WHERE(active, h * bounded, *REAL(self->h));
    *REAL(self->after_rejection) = AS_NUMBER(active & ~accepted);
    *REAL(self->rejected) += AS_NUMBER(active & ~accepted);
    return accepted;
}

/* Makes the corrections besides the projection in these lanes. A lane in which they fail leaves. */
ZD_KERNEL void correct_rest(zd_lanes *self, zd_condition which, const double *t, double *y, int forced)
{
    if (!self->correct_rest) return;
    *REAL(self->is_corrected) = AS_NUMBER(which);
    self->correct_rest(self->of, t, y, forced);
}

/* True in lanes that require attention: a sample or a check is due. After a step that requests it, a check follows the next multiple of
 * eight steps. */
ZD_KERNEL zd_condition is_due(zd_lanes *self)
{
    const zd_real magic = ZD_SPLAT(0x1p52), number = *REAL(self->number);
    const zd_real eights = (0.125 * (number + 1.0) - 0.4375 + magic) - magic, soon = 8.0 * (eights + 1.0);
    const zd_real due = *REAL(self->next_check);
    const zd_real next = ZD_WHERE(HOLDS(self->check_soon) & (soon < due), soon, due);
    *REAL(self->next_check) = next;
    return (*REAL(self->t) >= *REAL(self->next_t)) | (number >= *REAL(self->next_number)) | (number >= next);
}

/* True in lanes in which an entry of y passes zero in the last fixed step, or its cubic Hermite polynomial may. */
ZD_KERNEL zd_condition may_pass(const zd_lanes *self, const zd_watched *event, zd_real h)
{
    const int i = event->entry, nq = self->nq;
    const zd_real before = REAL(self->y0)[i] - event->level, now = REAL(self->y)[i] - event->level, change = now - before;
    const zd_real rate1 = i < nq ? REAL(rates_at(self, self->y, self->pdot))[i] : REAL(self->vdot)[i - nq];
    const zd_real bow = size_of(h * REAL(self->k)[i] - change) + size_of(h * rate1 - change);
    const zd_condition changes = ((before < 0.0) & (now >= 0.0)) | ((before > 0.0) & (now <= 0.0));
    return changes | (SMALLER(size_of(before), size_of(now)) <= bow);
}

/* True in lanes in which events may have occurred in the last step. */
ZD_KERNEL zd_condition has_events(const zd_lanes *self)
{
    zd_condition any = {0};
    if (self->watches == ZD_WATCHES_STEPS) return ~any;
    for (int i = 0; i < self->events; i++) any |= may_pass(self, self->watched + i, *REAL(self->t) - *REAL(self->t_before));
    return any;
}

/* Projects y1 onto the constraints, if that is due in this step. Returns the lanes in which that fails. */
ZD_KERNEL zd_condition project(zd_lanes *self, zd_condition accepted, const double *t1)
{
    const zd_condition none = {0};
    if (!self->m || !self->corrects) return none;
    if (self->every > 1) accepted &= is_multiple(*REAL(self->number) + 1.0, self->every) | (*REAL(t1) == self->end);
    return ZD_ANY(accepted) ? correct_state(self, t1, self->y1, accepted) & accepted : none;
}

/* Makes a step in each lane; returns the lanes that require attention. */
ZD_KERNEL zd_condition step(zd_lanes *self)
{
    const zd_condition active = HOLDS(self->is_active);
    zd_real h, speed, wanted = *REAL(self->t);
    zd_stored t1;
    t1 = end_of_step(self, &h);
    const zd_condition stands = ~(t1 > wanted) & active;        /* step size underflow */
    const zd_real taken = ZD_WHERE(active, h, 0.0);
    t1 = ZD_WHERE(active, t1, wanted);
    begin(self);
    integrate(self, self->y, wanted, taken, self->y1);
    zd_condition accepted = active, failed = stands, continues;
    if (!self->is_fixed) {
        const zd_real norm = error(self, (const double *)&t1, taken);
        failed |= active & (norm != norm);
        accepted &= control(self, h, norm);
    }
    failed |= project(self, accepted, (const double *)&t1);
    correct_rest(self, accepted & ~failed, (const double *)&t1, self->y1, 0);
    const zd_lane_rates to = {self->pdot1, self->vdot1, NULL, self->has_input ? self->power1 : NULL, self->pivots1};
    accelerate(self, (const double *)&t1, self->y1, self->y1 + self->nq * ZD_LANES, &to);
    failed |= accepted & ~is_accepted(self, taken, &speed, &continues);
    accepted &= ~failed;
    keep(self, accepted, t1, speed, continues);
    if (!self->is_fixed) failed |= active & (~(*REAL(self->h) > self->tiny) | (*REAL(self->number) > self->max_steps));
    *REAL(self->leaves) = ZD_WHERE(failed, 1.0, *REAL(self->leaves));
    const zd_condition due = is_due(self);
    if (!self->watches) return failed | (accepted & (due | HOLDS(self->is_long)));
    const zd_condition happens = accepted & has_events(self);
    *REAL(self->has_event) = AS_NUMBER(happens);
    return failed | happens | (accepted & (due | HOLDS(self->is_long)));
}

ZD_KERNEL void advance(zd_lanes *self)
{
    self->has_polynomial = 0;
    for (;;) {
        const zd_condition seen = step(self);
        const zd_real order = *REAL(self->order);
        if (ZD_ANY(order != order)) choose(self);
        if (ZD_ANY(seen | HOLDS(self->leaves))) return;
    }
}

/* ---- within the last step ---- */

/* Dense output of the last step, in these lanes: polynomial through y0 and y from the rates at the ends of the step and of some more
 * stages: interpolation.h. */
ZD_KERNEL void prepare_dense(zd_lanes *self, zd_condition which, zd_real h)
{
    const zd_method *method = &self->method;
    const int size = self->size, f1 = method->stages;
    zd_stored at_stage = *REAL(self->t);
    rate(self, (const double *)&at_stage, self->y, self->k + f1 * size * ZD_LANES);
    for (int i = 0; i < method->tableau->more; i++) {
        at_stage = *REAL(self->t_before) + method->tableau->more_c[i] * h;
        combine(self, &method->more[i], h, self->y0, self->stage);
        rate(self, (const double *)&at_stage, self->stage, self->k + (f1 + 1 + i) * size * ZD_LANES);
    }
    zd_stored *F = REAL(self->polynomial), *k = REAL(self->k);
    for (int i = 0; i < size; i++) {
        const zd_real change = REAL(self->y)[i] - REAL(self->y0)[i];
        F[i] = ZD_WHERE(which, change, F[i]);
        F[size + i] = ZD_WHERE(which, h * k[i] - change, F[size + i]);
        F[2 * size + i] = ZD_WHERE(which, 2 * change - h * (k[f1 * size + i] + k[i]), F[2 * size + i]);
    }
    for (int i = 3; i < method->tableau->coefficients; i++) {
        combine(self, &method->d[i - 3], h, NULL, self->stage);
        take_where(which, size, self->stage, self->polynomial + i * size * ZD_LANES);
    }
}

ZD_KERNEL void evaluate(const zd_lanes *self, zd_real x)
{
    const int n = self->size, coefficients = self->method.tableau->coefficients;
    const zd_stored *F = REAL(self->polynomial);
    const zd_real z = 1 - x;
    for (int i = 0; i < n; i++) {
        zd_real value = F[(coefficients - 1) * n + i];
        for (int k = coefficients - 2; k >= 0; k--) value = F[k * n + i] + (k % 2 ? x : z) * value;
        REAL(self->y_sample)[i] = REAL(self->y0)[i] + x * value;
    }
}

/* Time within the step, in lanes in which one is requested that is not its end. */
typedef struct zd_lane_time {
    zd_condition inside;
    zd_real h, part;        /* size of the step, and its part up to that time; 0 in other lanes */
} zd_lane_time;

ZD_KERNEL zd_lane_time find_within(zd_lanes *self)
{
    const zd_real t = *REAL(self->t), before = *REAL(self->t_before), t_sample = *REAL(self->t_sample);
    const zd_condition inside = HOLDS(self->is_wanted) & (t_sample != t);
    const int has_dense = zd_lanes_have_dense_output(self);
    if (has_dense && !self->has_polynomial) prepare_dense(self, t == t, t - before);
    self->has_polynomial = has_dense;
    return (zd_lane_time){inside, ZD_WHERE(inside, t - before, 0.0), ZD_WHERE(inside, t_sample - before, 0.0)};
}

/* Projects y_sample onto the constraints at t_sample; evaluates its multipliers if required. */
ZD_KERNEL void project_within(zd_lanes *self, zd_condition inside, const double *t_sample, int multipliers)
{
    zd_condition failed = {0};
    if (self->m && self->corrects) failed = correct_state(self, t_sample, self->y_sample, inside) & inside;
    correct_rest(self, inside & ~failed, t_sample, self->y_sample, 1);
    take_where(~inside, self->size, self->y, self->y_sample);
    *REAL(self->leaves) = ZD_WHERE(failed, 1.0, *REAL(self->leaves));
    if (!multipliers) return;
    const zd_lane_rates to = {self->pdot1, self->vdot1, self->lambda_sample, NULL, NULL};
    accelerate(self, t_sample, self->y_sample, self->y_sample + self->nq * ZD_LANES, &to);
}

/* y_sample at t_sample in the lanes that are returned, by dense output if there is a polynomial and it is to be taken, else by a shorter
 * step. Orders of elimination may have changed since the start of the step; they are valid at its end. */
ZD_KERNEL zd_condition go_within(zd_lanes *self, int takes_polynomial, int multipliers)
{
    const zd_lane_time at = find_within(self);
    const zd_stored t_sample = ZD_WHERE(at.inside, *REAL(self->t_sample), *REAL(self->t));
    if (takes_polynomial && self->has_polynomial)
        evaluate(self, ZD_WHERE(at.inside, at.part / ZD_WHERE(at.inside, at.h, 1.0), 1.0));
    else integrate(self, self->y0, *REAL(self->t_before), at.part, self->y_sample);
    project_within(self, at.inside, (const double *)&t_sample, multipliers);
    return at.inside;
}

ZD_KERNEL void move_within(zd_lanes *self, int multipliers)
{
    go_within(self, 1, multipliers);
}

/* The stages of a shorter step overwrite those of dense output, which is therefore computed before. */
ZD_KERNEL void substep(zd_lanes *self)
{
    go_within(self, 0, 0);
}

/* The same, and the shorter step replaces the last one, with its dense output. */
ZD_KERNEL void cut(zd_lanes *self)
{
    const zd_condition inside = go_within(self, 0, 0);
    take_where(inside, self->size, self->y_sample, self->y);
    *REAL(self->t) = ZD_WHERE(inside, *REAL(self->t_sample), *REAL(self->t));
    prepare_dense(self, inside, *REAL(self->t) - *REAL(self->t_before));
}

/* The functions of this unit. */
#define ZD_LANE_FUNCTIONS {ZD_LANES, choose, renew, advance, move_within, substep, cut, check}
