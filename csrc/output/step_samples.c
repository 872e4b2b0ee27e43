/* Samples of event functions within a step, between which they pass zero at most once. Values of a polynomial without corrections, which
 * costs little, show the steps in which a function may pass zero and return: dense output with adaptive steps, a cubic Hermite polynomial
 * with fixed steps. In such a step, corrected values replace them: of dense output or shorter steps. Series, states in independent
 * velocities, and accelerations within adaptive steps lack such a polynomial: all their steps have corrected values.
 */
#include "watch.h"

#include <math.h>

#include "../linalg/small.h"
#include "../point/point.h"

static const double SMALL_CHANGE = 0x1p-20;     /* change of coordinates by which a function is seen to rise or to fall */

static int is_fixed(const zd_watch *self)
{
    return self->at_end.vdot != NULL;
}

static int reads_any_accelerations(const zd_watch *self)
{
    int any = 0;
    for (int i = 0; i < self->events->count; i++) any |= zd_watch_reads_accelerations(self, i);
    return any;
}

int zd_watch_correct(zd_stepper *stepper)
{
    return zd_path_end(stepper, stepper->t, 0);
}

int zd_watch_move(zd_watch *self, double t)
{
    zd_stepper *stepper = self->output->stepper;
    const zd_state *before = &self->output->before, *end = &self->end;
    if (t > before->t && t < end->t) return zd_output_go(self->output, t);
    int status = zd_stepper_return_to(stepper, t == end->t ? end : before);
    return status || t == end->t ? status : zd_watch_correct(stepper);
}

static double time_of_sample(const zd_watch *self, int k)
{
    const double t0 = self->output->before.t;
    return t0 + zd_sample_share(k) * (self->end.t - t0);
}

/* ---- contacts that stay open ---- */

int zd_watch_find_gaps(zd_watch *self)
{
    const zd_phase_system *phase = self->output->stepper->motion->point->phase;
    const zd_state *before = &self->output->before, *end = &self->end;
    if (!self->gaps->gap) return ZD_DONE;
    self->end_gaps = !self->end_gaps;
    const int status = zd_gaps_find(&self->gaps[!self->end_gaps], phase, before->t, before->p, before->v);
    return status ? status : zd_gaps_find(&self->gaps[self->end_gaps], phase, end->t, end->p, end->v);
}

/* Leaves contacts that stay open without samples within the step. */
static void skip_open_contacts(zd_watch *self)
{
    const zd_point *point = self->output->stepper->motion->point;
    const zd_gaps *before = &self->gaps[!self->end_gaps], *after = &self->gaps[self->end_gaps];
    if (!after->gap || !(zd_gaps_distance(before, after, point->system->nv, point->inverse_unit) < ZD_SMALL_DISPLACEMENT)) return;
    const int groups = point->phase->full->groups, own = self->events->count - groups;
    for (int g = 0; g < groups; g++)
        if (zd_gap_stays_open(point->phase, before, after, g)) zd_zeros_keep_ends(&self->zeros[own + g], 0);
}

static int needs_samples(const zd_watch *self)
{
    int any = 0;
    for (int i = 0; i < self->events->count; i++) any |= self->zeros[i].count > 2;
    return any;
}

/* ---- prediction ---- */

static int find_rates(const zd_watch *self, zd_end_rates *rates)
{
    const int status = zd_stepper_rates(self->output->stepper, rates->pdot, rates->vdot);
    rates->are_known = !status;
    return status;
}

/* *value <- the event function where the motion would be after a time s at the present rates */
static int value_after(zd_watch *self, int event, const zd_end_rates *rates, double s, double *value)
{
    const zd_stepper *stepper = self->output->stepper;
    const zd_point *point = stepper->motion->point;
    zd_state *there = &self->mixed;
    there->t = stepper->t + s;
    for (int i = 0; i < point->system->nq; i++) there->p[i] = point->p[i] + s * rates->pdot[i];
    for (int i = 0; i < point->system->nv; i++) there->v[i] = point->v[i] + s * rates->vdot[i];
    return zd_watch_evaluate_at(self, event, there, value);
}

int zd_watch_arm(zd_watch *self)
{
    const int event = self->disarmed - 1;
    const zd_system *system = &self->output->stepper->motion->system;
    zd_end_rates rates = {self->early.p, self->late.v, 0};
    double *value = &self->before[event], ahead = 0, behind = 0, now = 0, rounding = 0;
    int status = find_rates(self, &rates);
    self->disarmed = 0;
    if (status) return status;
    const double s = SMALL_CHANGE / fmax(1, fmax(zd_max_abs(system->nq, rates.pdot), zd_max_abs(system->nv, rates.vdot)));
    status = value_after(self, event, &rates, s, &ahead);
    if (!status) status = value_after(self, event, &rates, -s, &behind);
    if (!status) status = zd_watch_evaluate(self, event, &now);
    if (!status) status = zd_watch_rounding(self, event, now, &rounding);
    *value = fabs(ahead - behind) > rounding ? ahead - behind : 0;
    return status;
}

void zd_watch_before(zd_watch *self)
{
    if (is_fixed(self)) find_rates(self, &self->at_start);
}

/* y (n,) <- the cubic Hermite polynomial of a step of size h, at a fraction x of it */
void zd_interpolate_cubic(int n, double x, double h, const double *y0, const double *rate0, const double *y1, const double *rate1,
                          double *y)
{
    const double z = 1 - x;
    for (int i = 0; i < n; i++) {
        const double change = y1[i] - y0[i];
        y[i] = y0[i] + x * (change + z * (z * (h * rate0[i] - change) - x * (h * rate1[i] - change)));
    }
}

static void predict_by_rates(zd_watch *self, double x)
{
    const zd_system *system = &self->output->stepper->motion->system;
    const zd_state *before = &self->output->before, *end = &self->end;
    const double h = end->t - before->t;
    zd_interpolate_cubic(system->nq, x, h, before->p, self->at_start.pdot, end->p, self->at_end.pdot, self->mixed.p);
    zd_interpolate_cubic(system->nv, x, h, before->v, self->at_start.vdot, end->v, self->at_end.vdot, self->mixed.v);
}

static void predict_by_dense_output(zd_watch *self, double x)
{
    const zd_stepper *stepper = self->output->stepper;
    const zd_system *system = &stepper->motion->system;
    double *y = self->output->y;
    stepper->integrator->dense_output(stepper->memory, x, stepper->last.y, y);
    zd_copy_all(system->nq, y, self->mixed.p);
    zd_copy_all(system->nv, y + system->nq, self->mixed.v);
}

/* Moves `mixed` to the polynomial, and the point, too, if `moves`. */
static int predict_state(zd_watch *self, int k, int moves)
{
    const double x = zd_sample_share(k);
    zd_stepper *stepper = self->output->stepper;
    const zd_system *system = &stepper->motion->system;
    zd_state *there = &self->mixed;
    there->t = time_of_sample(self, k);
    if (is_fixed(self)) predict_by_rates(self, x);
    else predict_by_dense_output(self, x);
    zd_quaternions_normalise(system, there->p);
    if (system->followers) system->follow(system->data, there->p);
    if (!moves) return ZD_DONE;
    zd_copy_all(stepper->motion->rate.size - stepper->motion->formulation_size, self->end.extra, there->extra);
    return zd_stepper_return_to(stepper, there);
}

static int predict_values(zd_watch *self, int k, int moves)
{
    int status = predict_state(self, k, moves);
    for (int i = 0; !status && i < self->events->count; i++) {
        zd_zeros *zeros = &self->zeros[i];
        if (zeros->count == 2) continue;
        zeros->t[k] = self->mixed.t;
        status = zd_watch_reads_accelerations(self, i) ? zd_watch_evaluate(self, i, &zeros->g[k])
                                                       : zd_watch_evaluate_at(self, i, &self->mixed, &zeros->g[k]);
    }
    return status;
}

static int may_predict(const zd_watch *self)
{
    const zd_stepper *stepper = self->output->stepper;
    if (is_fixed(self)) return self->at_start.are_known;
    return zd_output_has_dense(self->output) && stepper->last.p == stepper->last.y && !reads_any_accelerations(self);
}

/* Prepares the polynomial; *is_known <- 0 if dense output failed. */
static int prepare_prediction(zd_watch *self, int moves, int *is_known)
{
    zd_output *output = self->output;
    int status = is_fixed(self) ? find_rates(self, &self->at_end) : zd_watch_leave(self);
    if (!status && moves && !output->is_within) zd_output_save_end(output);
    *is_known = is_fixed(self) || output->is_prepared;
    return status;
}

/* Largest change of each event function by the corrections, at two samples. */
static int compare_with_corrected(zd_watch *self)
{
    static const int at[] = {6, ZD_SAMPLES + 1 - 6};
    int status = ZD_DONE;
    for (int j = 0; !status && j < 2; j++) {
        status = zd_watch_move(self, time_of_sample(self, at[j]));
        for (int i = 0; !status && i < self->events->count; i++) {
            double g;
            if (self->zeros[i].count == 2) continue;
            status = zd_watch_evaluate(self, i, &g);
            if (!status) zd_zeros_compare(&self->zeros[i], at[j], g);
        }
    }
    return status;
}

static int predict_all(zd_watch *self, int *is_known)
{
    const int moves = is_fixed(self) && reads_any_accelerations(self);
    int status = prepare_prediction(self, moves, is_known);
    for (int k = 1; !status && *is_known && k <= ZD_SAMPLES; k++) status = predict_values(self, k, moves);
    return status || !*is_known || is_fixed(self) ? status : compare_with_corrected(self);
}

/* Events that pass zero at most once by the prediction keep the ends of the step alone, as those of fixed steps without it. */
static int occurs_by(zd_watch *self, int event, int is_known)
{
    zd_zeros *zeros = &self->zeros[event];
    if (zeros->count > 2 && (is_known ? !zd_zeros_are_paired(zeros) : is_fixed(self))) zd_zeros_keep_ends(zeros, is_known);
    return zeros->count > 2 || zd_passes_zero(self->before[event], self->now[event], self->events->direction[event]);
}

void zd_watch_span(zd_watch *self)
{
    const int last = ZD_SAMPLES + 1;
    for (int i = 0; i < self->events->count; i++) {
        zd_zeros *zeros = &self->zeros[i];
        zeros->count = last + 1;
        zeros->error = 0;
        zeros->expected = NAN;
        zeros->t[0] = self->output->before.t, zeros->g[0] = self->before[i];
        zeros->t[last] = self->end.t, zeros->g[last] = self->now[i];
    }
}

int zd_watch_leave(zd_watch *self)
{
    zd_output *output = self->output;
    const int is_corrected = output->is_within && !output->is_prepared;
    int status = is_corrected && zd_output_has_dense(output) ? zd_output_return_to_end(output) : ZD_DONE;
    return status || output->is_within ? status : zd_output_leave(output);
}

int zd_watch_predict(zd_watch *self, int *occurs)
{
    zd_watch_span(self);
    skip_open_contacts(self);
    int is_known = needs_samples(self) && may_predict(self), status = is_known ? predict_all(self, &is_known) : ZD_DONE;
    for (int i = 0; !status && i < self->events->count; i++) *occurs |= occurs_by(self, i, is_known);
    return status;
}

/* ---- samples ---- */

static int take_sample(zd_watch *self, int k)
{
    const double t = time_of_sample(self, k);
    int status = zd_watch_move(self, t);
    for (int i = 0; !status && i < self->events->count; i++) {
        zd_zeros *zeros = &self->zeros[i];
        if (zeros->count == 2) continue;
        zeros->t[k] = t;
        status = zd_watch_evaluate(self, i, &zeros->g[k]);
    }
    return status;
}

static int find_pairs(zd_watch *self, int event)
{
    zd_zeros *zeros = &self->zeros[event];
    int status = ZD_DONE;
    zd_zeros_begin(zeros);
    while (!status && zd_zeros_next(zeros)) {
        double g, rounding;
        status = zd_watch_move(self, zeros->next);
        if (!status) status = zd_watch_evaluate(self, event, &g);
        if (!status) status = zd_watch_rounding(self, event, g, &rounding);
        if (!status) zd_zeros_narrow(zeros, g, rounding);
    }
    return status;
}

int zd_watch_sample(zd_watch *self)
{
    int status = ZD_DONE;
    const int any = needs_samples(self);
    for (int k = 1; any && !status && k <= ZD_SAMPLES; k++) status = take_sample(self, k);
    for (int i = 0; any && !status && i < self->events->count; i++) status = find_pairs(self, i);
    return status;
}
