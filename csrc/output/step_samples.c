/* Samples of event functions within a step, between which they pass zero at most once: of the dense output with adaptive steps of a method
 * that has one, and of shorter steps of a series. With other fixed steps, values of the cubic Hermite polynomial show the steps in which a
 * function may pass zero and return; there, they are replaced by those of shorter steps.
 */
#include "step_samples.h"

#include "../paths/choose.h"
#include "../point/matrices.h"
#include "../point/quaternions.h"

static int is_sampled_directly(const zd_watch *self)
{
    return !self->at_end.vdot;
}

int zd_watch_correct(zd_stepper *stepper)
{
    return zd_path_end(zd_path_of_state(stepper->motion), stepper, stepper->t, 0, 1, 0);
}

int zd_watch_move(zd_watch *self, double t)
{
    zd_stepper *stepper = self->output->stepper;
    const zd_state *before = &self->output->before, *end = &self->end;
    if (t > before->t && t < end->t) return zd_output_go(self->output, t);
    int status = zd_stepper_return_to(stepper, t == end->t ? end : before);
    return status || t == end->t ? status : zd_watch_correct(stepper);
}

/* ---- prediction ---- */

static int find_rates(const zd_watch *self, zd_end_rates *rates)
{
    rates->are_known = 0;
    zd_motion *motion = self->output->stepper->motion;
    zd_point *point = motion->point;
    int status = zd_motion_accelerate(motion);
    if (!status && zd_has_A(point->system)) status = zd_point_need_times_A(point, 0);
    if (status) return status;
    if (zd_has_A(point->system)) zd_point_rate(point, point->v, rates->pdot);
    else zd_copy_all(point->system->nv, point->v, rates->pdot);
    zd_copy_all(point->system->nv, point->vdot, rates->vdot);
    rates->are_known = 1;
    return ZD_DONE;
}

void zd_watch_before(zd_watch *self)
{
    if (!is_sampled_directly(self)) find_rates(self, &self->at_start);
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

/* Moves `mixed` to the cubic Hermite polynomial, and the point, too, if `moves`. */
static int predict_state(zd_watch *self, double x, int moves)
{
    zd_stepper *stepper = self->output->stepper;
    const zd_system *system = &stepper->motion->system;
    const zd_state *before = &self->output->before, *end = &self->end;
    zd_state *there = &self->mixed;
    const double h = end->t - before->t;
    there->t = before->t + x * h;
    zd_interpolate_cubic(system->nq, x, h, before->p, self->at_start.pdot, end->p, self->at_end.pdot, there->p);
    zd_interpolate_cubic(system->nv, x, h, before->v, self->at_start.vdot, end->v, self->at_end.vdot, there->v);
    zd_quaternions_normalise(system, there->p);
    if (system->followers) system->follow(system->data, there->p);
    zd_copy_all(stepper->motion->rate.size - stepper->motion->formulation_size, end->extra, there->extra);
    return moves ? zd_stepper_return_to(stepper, there) : ZD_DONE;
}

static int predict_values(zd_watch *self, int k, int moves)
{
    int status = predict_state(self, zd_sample_share(k), moves);
    for (int i = 0; !status && i < self->events->count; i++) {
        zd_zeros *zeros = &self->zeros[i];
        zeros->t[k] = self->mixed.t;
        status = zd_watch_reads_accelerations(self, i) ? zd_watch_evaluate(self, i, &zeros->g[k])
                                                       : zd_watch_evaluate_at(self, i, &self->mixed, &zeros->g[k]);
    }
    return status;
}

static int predict_all(zd_watch *self)
{
    int moves = 0, status = find_rates(self, &self->at_end);
    for (int i = 0; i < self->events->count; i++) moves |= zd_watch_reads_accelerations(self, i);
    if (!status && moves && !self->output->is_away) zd_output_leave_end(self->output);
    for (int k = 1; !status && k <= ZD_SAMPLES; k++) status = predict_values(self, k, moves);
    return status;
}

/* Events that pass zero at most once by the prediction keep the ends of the step alone. */
static int occurs_by(zd_watch *self, int event)
{
    zd_zeros *zeros = &self->zeros[event];
    if (!self->at_start.are_known || !zd_zeros_are_paired(zeros)) zd_zeros_keep_ends(zeros);
    return zeros->count > 2 || zd_passes_zero(self->before[event], self->now[event], self->events->direction[event]);
}

void zd_watch_span(zd_watch *self)
{
    const int last = ZD_SAMPLES + 1;
    for (int i = 0; i < self->events->count; i++) {
        zd_zeros *zeros = &self->zeros[i];
        zeros->count = last + 1;
        zeros->t[0] = self->output->before.t, zeros->g[0] = self->before[i];
        zeros->t[last] = self->end.t, zeros->g[last] = self->now[i];
    }
}

int zd_watch_predict(zd_watch *self, int *occurs)
{
    zd_stepper_keep_place(self->output->stepper, &self->end);
    zd_watch_span(self);
    *occurs = is_sampled_directly(self);
    if (*occurs) return ZD_DONE;
    int status = self->at_start.are_known ? predict_all(self) : ZD_DONE;
    for (int i = 0; !status && i < self->events->count; i++) *occurs |= occurs_by(self, i);
    return status;
}

/* ---- samples ---- */

static int take_sample(zd_watch *self, int k)
{
    const double t0 = self->output->before.t, t = t0 + zd_sample_share(k) * (self->end.t - t0);
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
    int status = ZD_DONE, any = 0;
    for (int i = 0; i < self->events->count; i++) any |= self->zeros[i].count > 2;
    for (int k = 1; any && !status && k <= ZD_SAMPLES; k++) status = take_sample(self, k);
    for (int i = 0; any && !status && i < self->events->count; i++) status = find_pairs(self, i);
    return status;
}
