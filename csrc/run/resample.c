/* Resampling: the step from one sample to the next is repeated and its dense output evaluated, as a run does with t_eval; if the run would
 * take a shorter step instead, so does this. The bits are the same if a step depends on its start only.
 *
 * Characteristic scales, the initial energy and the order of pivots come from the start of the run, which is the same here.
 */
#include "contacts.h"

#include <math.h>
#include <string.h>

#include "../paths/path.h"
#include "../state/stepper.h"
#include "../step/step_loop.h"
#include "../step_limits.h"

/* One sample of an array with `size` numbers per sample. */
static const double *sample_of(const zd_saved *saved, const double *array, int size, int64_t sample)
{
    return array + sample * (saved->stride ? saved->stride : size);
}

static double time_of(const zd_saved *saved, int64_t sample)
{
    return *sample_of(saved, saved->t, 1, sample);
}

static int64_t sample_before(const zd_saved *saved, double t)
{
    int64_t low = 0, high = saved->samples;      /* the sample searched for is one of low ... high - 1 */
    while (high - low > 1) {
        const int64_t middle = low + (high - low) / 2;
        if (time_of(saved, middle) <= t) low = middle;
        else high = middle;
    }
    return low;
}

/* Offsets of joints that are joined in the state of a sample (groups,): Phi there, of those that were joined open. */
static int find_offsets(zd_phases *phases, const signed char *state, double t, const double *p, const double *v)
{
    const zd_system *full = phases->full;
    const int status = zd_phase_evaluate(phases->present->of, ZD_PHI, t, p, v);
    for (int g = 0; !status && g < full->groups; g++) {
        const zd_group *group = full->group + g;
        if (group->kind != ZD_TWO_SIDED || state[g] != ZD_CLOSED) continue;
        for (int k = group->first; k < group->first + group->rows && k < full->mh; k++) {
            const double Phi = zd_phase_Phi(phases->present->of)[k];
            phases->offset[k] = fabs(Phi) > ZD_PENETRATION * phases->length ? Phi : 0;
        }
    }
    return status;
}

static int place(zd_resample *self, int64_t sample)
{
    zd_motion *motion = &self->run->motion;
    zd_stepper *stepper = &self->run->stepper;
    const zd_saved *saved = self->saved;
    const double *p = sample_of(saved, saved->p, motion->system.nq, sample), *v = sample_of(saved, saved->v, motion->system.nv, sample);
    if (self->run->phases) {
        const double input = saved->input ? *sample_of(saved, saved->input, 1, sample) : 0, t = time_of(saved, sample);
        const signed char *state = saved->state + sample * self->run->phases->full->groups;
        int status = find_offsets(self->run->phases, state, t, p, v);
        if (!status) status = zd_phases_place(self->run, state, t, p, v, input);
        return status ? status : zd_phase_update_directions(self->run->phases->present->of, 1, t, p, v);
    }
    if (motion->balance.input && saved->input) stepper->y[motion->rate.size - 1] = *sample_of(saved, saved->input, 1, sample);
    return zd_stepper_set_state(stepper, time_of(saved, sample), p, v);
}

static int make_step(zd_resample *self, int64_t sample)
{
    zd_step_loop *loop = &self->run->loop;
    const int status = zd_pass_break(loop);     /* ZD_PAUSED: a jump, which needs no notice */
    const double t = self->run->stepper.t, next = time_of(self->saved, sample + 1);
    if (status < 0 || t == next) return status < 0 ? status : ZD_DONE;
    const int is_last = sample + 2 == self->saved->samples;
    const int is_cut_short = self->run->settings.step - (next - t) > ZD_TIME_RESOLUTION * fmax(fabs(t), fabs(next));
    return zd_step_attempt(loop, &(zd_attempt){
        .kind = ZD_REPEATED_STEP, .forced = is_last, .step = sample + 1,
        .h = zd_is_adaptive(loop) || is_last || is_cut_short ? next - t : self->run->settings.step, .t1 = next,
    });
}

static int is_at(const zd_resample *self, int64_t sample)
{
    const zd_point *point = self->run->motion.point;
    const zd_saved *saved = self->saved;
    const int nq = point->system->nq, nv = point->system->nv;
    return !memcmp(point->p, sample_of(saved, saved->p, nq, sample), nq * sizeof(double))
        && !memcmp(point->v, sample_of(saved, saved->v, nv, sample), nv * sizeof(double));
}

/* Moves to a sample and chooses the evaluation path of a step from there. */
static int begin(zd_resample *self, int64_t sample, int is_general)
{
    zd_motion *motion = &self->run->motion;
    if (is_general) zd_closed_form_leave(motion);
    int status = place(self, sample);
    if (!status && !is_general) zd_closed_form_choose(motion);
    return status;
}

static int make_step_from(zd_resample *self, int64_t sample, int is_general)
{
    int status = begin(self, sample, is_general);
    return status ? status : make_step(self, sample);
}

/* begin(), if a closed-form step may have ended at the sample: the acceleration at its end comes from another function, whose rounding may
 * differ, so that step is repeated first. A step cut short by an event was made from the sample itself. */
static int begin_from_before(zd_resample *self, int64_t sample)
{
    zd_motion *motion = &self->run->motion;
    const int is_cut = self->saved->ends_in_event && sample + 2 == self->saved->samples;
    int status = begin(self, sample, 0);
    if (status || !zd_finishes_in_closed_form(motion) || sample == 0 || is_cut) return status;
    status = make_step_from(self, sample - 1, 0);
    if (status || !is_at(self, sample)) return begin(self, sample, 0);
    zd_closed_form_choose(motion);
    return ZD_DONE;
}

/* Repeats the step from a sample on each evaluation path until the next sample is reproduced bit for bit, as the run may have left the
 * closed-form path in it. If neither reproduces it, the step in closed form stands. */
static int make_on_each_path(zd_resample *self, int64_t sample)
{
    int status = begin_from_before(self, sample);
    if (!status) status = make_step(self, sample);
    if ((!status && is_at(self, sample + 1)) || !zd_closed_form_leave(&self->run->motion)) return status;
    const int general_status = make_step_from(self, sample, 1);
    self->is_general = status || (!general_status && is_at(self, sample + 1));
    return self->is_general ? general_status : make_step_from(self, sample, 0);
}

/* True if the repeated step ends within the tolerance of a sample. */
static int is_near(const zd_resample *self, int64_t sample)
{
    const zd_point *point = self->run->motion.point;
    const zd_settings *settings = &self->run->settings;
    const double *p = sample_of(self->saved, self->saved->p, point->system->nq, sample);
    int is = 1;
    for (int i = 0; i < point->system->nq; i++) is &= fabs(point->p[i] - p[i]) <= settings->atol + settings->rtol * fabs(p[i]);
    return is;
}

static void compare(zd_resample *self, int64_t sample)
{
    const zd_saved *saved = self->saved;
    const zd_system *system = &self->run->motion.system;
    zd_switching_compare(&self->run->loop, time_of(saved, sample), sample_of(saved, saved->p, system->nq, sample),
                         sample_of(saved, saved->v, system->nv, sample));
}

/* Repeats a step that begins or ends where a comparison changes at which a force jumps, with that as it was in the step; 0: it is another. */
static int make_at_switch(zd_resample *self, int64_t sample, int *status)
{
    zd_step_loop *loop = &self->run->loop;
    if (!loop->switching.count) return 0;
    for (int64_t i = self->known_samples; i < self->saved->samples; i++) compare(self, i);
    self->known_samples = self->saved->samples;
    compare(self, sample);
    compare(self, sample + 1);
    if (!zd_switching_hold_between(loop)) return 0;
    self->is_general = 1;
    *status = make_step_from(self, sample, 1);
    if (!*status && is_near(self, sample + 1)) return 1;
    zd_switching_turn(loop);
    *status = make_step_from(self, sample, 1);
    return 1;
}

/* The same again in (p, v) if it ends elsewhere, as the run had chosen other independent variables before the sample. */
static int make_again(zd_resample *self, int64_t sample)
{
    zd_stepper *stepper = &self->run->stepper;
    int status;
    zd_variables_restore(stepper);
    if (make_at_switch(self, sample, &status)) return status;
    status = make_on_each_path(self, sample);
    if (!stepper->dependent.formulation || !zd_is_adaptive(&self->run->loop) || (!status && is_near(self, sample + 1))) return status;
    zd_closed_form_leave(&self->run->motion);
    status = zd_variables_use_dependent(stepper);
    return status ? status : make_step(self, sample);
}

/* Finds the evaluation path of the step from a sample, and its dense output if available. Failures are ignored, since a shorter step may
 * succeed; except those of callables, which are returned. */
static int find_path(zd_resample *self, int64_t sample)
{
    zd_stepper *stepper = &self->run->stepper;
    const int may_interpolate = zd_is_adaptive(&self->run->loop) && stepper->integrator->prepare_dense;
    self->sample = sample;
    self->is_general = self->has_polynomial = 0;
    int status = may_interpolate || zd_has_closed_form(&self->run->motion) ? make_again(self, sample) : ZD_DONE;
    if (!status && may_interpolate && zd_has_dense_output(stepper, stepper->last.t)) {
        status = zd_dense_output_prepare(stepper);
        self->has_polynomial = !status;
    }
    if (!zd_callable_failed(&self->run->motion, status)) return ZD_DONE;
    self->sample = -1;
    return status;
}

int zd_resample_move(zd_resample *self, double t)
{
    const int64_t sample = sample_before(self->saved, t);
    if (t == time_of(self->saved, sample)) return place(self, sample);
    int status = sample == self->sample ? ZD_DONE : find_path(self, sample);
    if (status) return status;
    if (self->has_polynomial) {
        status = zd_dense_output_move(&self->run->stepper, t);
        if (!status || zd_callable_failed(&self->run->motion, status)) return status;
    }
    self->has_polynomial = 0;
    status = begin(self, sample, self->is_general);
    if (!status) status = zd_pass_break(&self->run->loop);
    return status ? status : zd_substep(&self->run->loop, t);
}
