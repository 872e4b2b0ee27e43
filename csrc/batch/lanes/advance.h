/* Step loop in all lanes at once, until one of them requires attention; and states within a step. */
#include "checks.h"

/* y1 from y, by the method's stages */
ZD_KERNEL void ZD_NAMED(integrate)(const zd_lanes *self, const double *from, zd_real t, zd_real h, double *to)
{
    const zd_method *method = &self->method;
    const int size = self->size;
    zd_stored at_stage;
    for (int i = 1; i < method->stages; i++) {
        double *rates = self->k + i * size * ZD_LANES;
        at_stage = t + method->tableau->c[i] * h;
        ZD_NAMED(combine)(self, 0, size, &method->a[i], h, from, self->stage);
        ZD_NAMED(rate)(self, (const double *)&at_stage, self->stage, rates);
    }
    ZD_NAMED(combine)(self, 0, size, &method->b, h, from, to);
}

/* Sets the first stage from the rates at the start of the step. */
ZD_KERNEL void ZD_NAMED(begin)(const zd_lanes *self)
{
    const int nq = self->nq, nv = self->nv;
    const zd_stored *rate = REAL(ZD_NAMED(rates_at)(self, self->y, self->pdot));
    for (int i = 0; i < nq; i++) REAL(self->k)[i] = rate[i];
    for (int i = 0; i < nv; i++) REAL(self->k)[nq + i] = REAL(self->vdot)[i];
    if (self->has_input) REAL(self->k)[nq + nv] = *REAL(self->power);
}

/* Time at the end of the step, and *h its size. */
ZD_KERNEL zd_real ZD_NAMED(end_of_step)(const zd_lanes *self, zd_real *h)
{
    const zd_real t = *REAL(self->t), end = ZD_SPLAT(self->end);
    if (self->is_fixed) {
        const zd_real number = *REAL(self->number) + 1.0;
        const zd_condition is_last = number == self->steps;
        const zd_real t1 = ZD_WHERE(is_last, end, self->t0 + number * self->step);
        const double rounding = ZD_TIME_RESOLUTION * fmax(fabs(self->t0), fabs(self->end));
        *h = ZD_WHERE(is_last & (ZD_NAMED(size_of)(end - t - self->step) > rounding), end - t, ZD_SPLAT(self->step));
        return t1;
    }
    zd_real size = *REAL(self->h);
    size = SMALLER(SMALLER(size, ZD_SPLAT(self->longest)), end - t);
    const zd_real t1 = ZD_WHERE(size == end - t, end, t + size);
    *h = t1 - t;
    return t1;
}

/* Sets the state to y1 in lanes whose step was accepted, and stores its start. */
ZD_KERNEL void ZD_NAMED(keep)(zd_lanes *self, zd_condition accepted, zd_real t1, zd_real speed, zd_condition continues)
{
    *REAL(self->t_before) = ZD_WHERE(accepted, *REAL(self->t), *REAL(self->t_before));
    ZD_NAMED(take_where)(accepted, self->size, self->y, self->y0);
    ZD_NAMED(take_where)(accepted, self->size, self->y1, self->y);
    ZD_NAMED(take_where)(accepted, self->has_A ? self->nq : 0, self->pdot1, self->pdot);
    ZD_NAMED(take_where)(accepted, self->nv, self->vdot1, self->vdot);
    ZD_NAMED(take_where)(accepted, self->nv, self->pivots1, self->pivots);
    if (self->has_input) ZD_NAMED(take_where)(accepted, 1, self->power1, self->power);
    *REAL(self->speed) = ZD_WHERE(accepted, speed, *REAL(self->speed));
    *REAL(self->t) = ZD_WHERE(accepted, t1, *REAL(self->t));
    *REAL(self->number) += AS_NUMBER(accepted);
    *REAL(self->order) = ZD_WHERE(accepted & ~continues, ZD_SPLAT(NAN), *REAL(self->order));
}

/* Size of the next step, from the error of this one; returns the lanes that accept it. */
ZD_KERNEL zd_condition ZD_NAMED(control)(zd_lanes *self, zd_real h, zd_real norm)
{
    const zd_condition active = HOLDS(self->is_active), accepted = norm <= 1.0;
    const zd_real factor = ZD_NAMED(factor)(self, norm);
    const zd_real bounded = ZD_WHERE(accepted & HOLDS(self->after_rejection) & (factor > 1.0), ZD_SPLAT(1.0), factor);
    *REAL(self->h) = ZD_WHERE(active, h * bounded, *REAL(self->h));
    *REAL(self->after_rejection) = AS_NUMBER(active & ~accepted);
    *REAL(self->rejected) += AS_NUMBER(active & ~accepted);
    return accepted;
}

/* Makes the corrections besides the projection in these lanes. A lane in which they fail leaves. */
ZD_KERNEL void ZD_NAMED(correct_rest)(zd_lanes *self, zd_condition which, const double *t, double *y, int forced)
{
    if (!self->correct_rest) return;
    *REAL(self->is_corrected) = AS_NUMBER(which);
    self->correct_rest(self->of, t, y, forced);
}

/* True in lanes that require attention: a sample or a check is due. After a step that requests it, a check follows the next multiple of
 * eight steps. */
ZD_KERNEL zd_condition ZD_NAMED(is_due)(zd_lanes *self)
{
    const zd_real magic = ZD_SPLAT(0x1p52), number = *REAL(self->number);
    const zd_real eights = (0.125 * (number + 1.0) - 0.4375 + magic) - magic, soon = 8.0 * (eights + 1.0);
    const zd_real due = *REAL(self->next_check);
    const zd_real next = ZD_WHERE(HOLDS(self->check_soon) & (soon < due), soon, due);
    *REAL(self->next_check) = next;
    return (*REAL(self->t) >= *REAL(self->next_t)) | (number >= *REAL(self->next_number)) | (number >= next);
}

/* True in lanes in which an entry of y passes zero in the last fixed step, or its cubic Hermite polynomial may. */
ZD_KERNEL zd_condition ZD_NAMED(may_pass)(const zd_lanes *self, const zd_watched *event, zd_real h)
{
    const int i = event->entry, nq = self->nq;
    const zd_real before = REAL(self->y0)[i] - event->level, now = REAL(self->y)[i] - event->level, change = now - before;
    const zd_real rate1 = i < nq ? REAL(ZD_NAMED(rates_at)(self, self->y, self->pdot))[i] : REAL(self->vdot)[i - nq];
    const zd_real bow = ZD_NAMED(size_of)(h * REAL(self->k)[i] - change) + ZD_NAMED(size_of)(h * rate1 - change);
    const zd_condition changes = ((before < 0.0) & (now >= 0.0)) | ((before > 0.0) & (now <= 0.0));
    return changes | (SMALLER(ZD_NAMED(size_of)(before), ZD_NAMED(size_of)(now)) <= bow);
}

/* True in lanes in which events may have occurred in the last step. */
ZD_KERNEL zd_condition ZD_NAMED(has_events)(const zd_lanes *self)
{
    zd_condition any = ZD_SPLAT(0.0) != 0.0;
    if (self->watches == ZD_WATCHES_STEPS) return ~any;
    for (int i = 0; i < self->events; i++) any |= ZD_NAMED(may_pass)(self, self->watched + i, *REAL(self->t) - *REAL(self->t_before));
    return any;
}

/* Projects y1 onto the constraints, if that is due in this step. Returns the lanes in which that fails. */
ZD_KERNEL zd_condition ZD_NAMED(project)(zd_lanes *self, zd_condition accepted, const double *t1)
{
    const zd_condition none = ZD_SPLAT(0.0) != 0.0;
    if (!self->m || !self->corrects) return none;
    if (self->every > 1) accepted &= ZD_NAMED(is_multiple)(*REAL(self->number) + 1.0, self->every) | (*REAL(t1) == self->end);
    return ZD_ANY(accepted) ? ZD_NAMED(correct_state)(self, t1, self->y1, accepted) & accepted : none;
}

/* Makes a step in each lane; returns the lanes that require attention. */
ZD_KERNEL zd_condition ZD_NAMED(step)(zd_lanes *self)
{
    const zd_condition active = HOLDS(self->is_active);
    zd_real h, speed, wanted = *REAL(self->t);
    zd_stored t1;
    t1 = ZD_NAMED(end_of_step)(self, &h);
    const zd_condition stands = ~(t1 > wanted) & active;        /* step size underflow */
    const zd_real taken = ZD_WHERE(active, h, ZD_SPLAT(0.0));
    t1 = ZD_WHERE(active, t1, wanted);
    ZD_NAMED(begin)(self);
    ZD_NAMED(integrate)(self, self->y, wanted, taken, self->y1);
    zd_condition accepted = active, failed = stands, continues;
    if (!self->is_fixed) {
        const zd_real norm = ZD_NAMED(error)(self, (const double *)&t1, taken);
        failed |= active & (norm != norm);
        accepted &= ZD_NAMED(control)(self, h, norm);
    }
    failed |= ZD_NAMED(project)(self, accepted, (const double *)&t1);
    ZD_NAMED(correct_rest)(self, accepted & ~failed, (const double *)&t1, self->y1, 0);
    const ZD_NAMED(rates) to = {self->pdot1, self->vdot1, NULL, self->has_input ? self->power1 : NULL, self->pivots1};
    ZD_NAMED(accelerate)(self, (const double *)&t1, self->y1, self->y1 + self->nq * ZD_LANES, &to);
    failed |= accepted & ~ZD_NAMED(is_accepted)(self, taken, &speed, &continues);
    accepted &= ~failed;
    ZD_NAMED(keep)(self, accepted, t1, speed, continues);
    if (!self->is_fixed) failed |= active & (~(*REAL(self->h) > self->tiny) | (*REAL(self->number) > self->max_steps));
    *REAL(self->leaves) = ZD_WHERE(failed, ZD_SPLAT(1.0), *REAL(self->leaves));
    const zd_condition is_due = ZD_NAMED(is_due)(self);
    if (!self->watches) return failed | (accepted & (is_due | HOLDS(self->is_long)));
    const zd_condition happens = accepted & ZD_NAMED(has_events)(self);
    *REAL(self->has_event) = AS_NUMBER(happens);
    return failed | happens | (accepted & (is_due | HOLDS(self->is_long)));
}

ZD_KERNEL void ZD_NAMED(advance)(zd_lanes *self)
{
    self->has_polynomial = 0;
    for (;;) {
        const zd_condition seen = ZD_NAMED(step)(self);
        const zd_real order = *REAL(self->order);
        if (ZD_ANY(order != order)) ZD_NAMED(choose)(self);
        if (ZD_ANY(seen | HOLDS(self->leaves))) return;
    }
}

/* ---- within the last step ---- */

/* Dense output of the last step, in these lanes: polynomial through y0 and y from the rates at the ends of the step and of some more
 * stages: interpolation.h. */
ZD_KERNEL void ZD_NAMED(prepare_dense)(zd_lanes *self, zd_condition which, zd_real h)
{
    const zd_method *method = &self->method;
    const int size = self->size, f1 = method->stages;
    zd_stored at_stage = *REAL(self->t);
    ZD_NAMED(rate)(self, (const double *)&at_stage, self->y, self->k + f1 * size * ZD_LANES);
    for (int i = 0; i < method->tableau->more; i++) {
        at_stage = *REAL(self->t_before) + method->tableau->more_c[i] * h;
        ZD_NAMED(combine)(self, 0, size, &method->more[i], h, self->y0, self->stage);
        ZD_NAMED(rate)(self, (const double *)&at_stage, self->stage, self->k + (f1 + 1 + i) * size * ZD_LANES);
    }
    zd_stored *F = REAL(self->polynomial), *k = REAL(self->k);
    for (int i = 0; i < size; i++) {
        const zd_real change = REAL(self->y)[i] - REAL(self->y0)[i];
        F[i] = ZD_WHERE(which, change, F[i]);
        F[size + i] = ZD_WHERE(which, h * k[i] - change, F[size + i]);
        F[2 * size + i] = ZD_WHERE(which, 2 * change - h * (k[f1 * size + i] + k[i]), F[2 * size + i]);
    }
    for (int i = 3; i < method->tableau->coefficients; i++) {
        ZD_NAMED(combine)(self, 0, size, &method->d[i - 3], h, NULL, self->stage);
        ZD_NAMED(take_where)(which, size, self->stage, self->polynomial + i * size * ZD_LANES);
    }
}

ZD_KERNEL void ZD_NAMED(evaluate)(const zd_lanes *self, zd_real x)
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
typedef struct ZD_NAMED(between) {
    zd_condition inside;
    zd_real h, part;        /* size of the step, and its part up to that time; 0 in other lanes */
} ZD_NAMED(between);

ZD_KERNEL ZD_NAMED(between) ZD_NAMED(find_within)(zd_lanes *self)
{
    const zd_real t = *REAL(self->t), before = *REAL(self->t_before), t_sample = *REAL(self->t_sample);
    const zd_condition inside = HOLDS(self->is_wanted) & (t_sample != t);
    const int has_dense = zd_lanes_have_dense_output(self);
    if (has_dense && !self->has_polynomial) ZD_NAMED(prepare_dense)(self, t == t, t - before);
    self->has_polynomial = has_dense;
    return (ZD_NAMED(between)){inside, ZD_WHERE(inside, t - before, ZD_SPLAT(0.0)), ZD_WHERE(inside, t_sample - before, ZD_SPLAT(0.0))};
}

/* Projects y_sample onto the constraints at t_sample; evaluates its multipliers if required. */
ZD_KERNEL void ZD_NAMED(project_within)(zd_lanes *self, zd_condition inside, const double *t_sample, int multipliers)
{
    zd_condition failed = ZD_SPLAT(0.0) != 0.0;
    if (self->m && self->corrects) failed = ZD_NAMED(correct_state)(self, t_sample, self->y_sample, inside) & inside;
    ZD_NAMED(correct_rest)(self, inside & ~failed, t_sample, self->y_sample, 1);
    ZD_NAMED(take_where)(~inside, self->size, self->y, self->y_sample);
    *REAL(self->leaves) = ZD_WHERE(failed, ZD_SPLAT(1.0), *REAL(self->leaves));
    if (!multipliers) return;
    const ZD_NAMED(rates) to = {self->pdot1, self->vdot1, self->lambda_sample, NULL, NULL};
    ZD_NAMED(accelerate)(self, t_sample, self->y_sample, self->y_sample + self->nq * ZD_LANES, &to);
}

/* y_sample at t_sample by dense output, if the method has it and steps are adaptive, else by a shorter step. Orders of elimination may have
 * changed since the start of the step; they are valid at its end. */
ZD_KERNEL void ZD_NAMED(move_within)(zd_lanes *self, int multipliers)
{
    const ZD_NAMED(between) at = ZD_NAMED(find_within)(self);
    const zd_stored t_sample = ZD_WHERE(at.inside, *REAL(self->t_sample), *REAL(self->t));
    if (self->has_polynomial)
        ZD_NAMED(evaluate)(self, ZD_WHERE(at.inside, at.part / ZD_WHERE(at.inside, at.h, ZD_SPLAT(1.0)), ZD_SPLAT(1.0)));
    else ZD_NAMED(integrate)(self, self->y0, *REAL(self->t_before), at.part, self->y_sample);
    ZD_NAMED(project_within)(self, at.inside, (const double *)&t_sample, multipliers);
}

/* y_sample at t_sample by a shorter step. Its stages overwrite those of dense output, which is therefore computed before. */
ZD_KERNEL zd_condition ZD_NAMED(make_shorter)(zd_lanes *self)
{
    const ZD_NAMED(between) at = ZD_NAMED(find_within)(self);
    const zd_stored t_sample = ZD_WHERE(at.inside, *REAL(self->t_sample), *REAL(self->t));
    ZD_NAMED(integrate)(self, self->y0, *REAL(self->t_before), at.part, self->y_sample);
    ZD_NAMED(project_within)(self, at.inside, (const double *)&t_sample, 0);
    return at.inside;
}

ZD_KERNEL void ZD_NAMED(substep)(zd_lanes *self)
{
    ZD_NAMED(make_shorter)(self);
}

/* The same, and the shorter step replaces the last one, with its dense output. */
ZD_KERNEL void ZD_NAMED(cut)(zd_lanes *self)
{
    const zd_condition inside = ZD_NAMED(make_shorter)(self);
    ZD_NAMED(take_where)(inside, self->size, self->y_sample, self->y);
    *REAL(self->t) = ZD_WHERE(inside, *REAL(self->t_sample), *REAL(self->t));
    ZD_NAMED(prepare_dense)(self, inside, *REAL(self->t) - *REAL(self->t_before));
}
