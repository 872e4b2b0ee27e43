/* Values between steps: from the start of the step, a shorter step of the same method is made to each requested time, and corrected as any
 * other. So the values satisfy the constraints and have the error of the method.
 *
 * With adaptive steps, the dense output of a method that has one costs less: its values, corrected alike, have errors as small as those of
 * such steps. Fixed steps may be too long for it.
 */
#include "within_step.h"

zd_output zd_output_create(zd_arena *arena, const zd_settings *settings, zd_step_loop *loop, zd_recorder *recorder)
{
    zd_stepper *stepper = loop->stepper;
    zd_output self = {
        .loop = loop,
        .stepper = stepper,
        .recorder = recorder,
        .t_eval = settings->t_eval,
        .t_evals = settings->t_evals,
        .has_polynomial = zd_is_adaptive(loop) && stepper->integrator->prepare_dense,
    };
    if (settings->t_eval || settings->events) {
        self.before = zd_state_create(arena, stepper->motion);
        self.after = zd_snapshot_create(arena, stepper);
        self.y = zd_arena_doubles(arena, self.has_polynomial ? stepper->capacity : 0);
    }
    return self;
}

void zd_output_save_start(zd_output *self)
{
    zd_stepper_save_state(self->stepper, &self->before);
    self->is_prepared = self->is_within = 0;
}

void zd_output_save_end(zd_output *self)
{
    zd_snapshot_take(&self->after, self->stepper, ZD_ACCELERATIONS | ZD_MEMORY);
    self->is_within = 1;
    self->is_prepared = 0;
}

int zd_output_return_to_end(zd_output *self)
{
    self->is_within = 0;
    return zd_snapshot_restore(&self->after, self->stepper);
}

/* Continues with shorter steps after dense output has failed. */
static int go_on_with_shorter_steps(zd_output *self)
{
    const int status = zd_output_return_to_end(self);
    if (!status) zd_output_save_end(self);
    return status;
}

/* Prepares the dense output of the step, unless events have done so: it is valid until the next step. */
static int leave_for_polynomial(zd_output *self)
{
    zd_stepper *stepper = self->stepper;
    self->is_within = 1;
    const int choice = stepper->motion->formulation->update ? ZD_VARIABLES : 0;
    zd_snapshot_take(&self->after, stepper, ZD_ACCELERATIONS | choice);
    int status = self->is_prepared ? ZD_DONE : zd_dense_output_prepare(stepper);
    self->is_prepared = !status;
    return !status || zd_callable_failed(stepper->motion, status) ? status : go_on_with_shorter_steps(self);
}

int zd_output_leave(zd_output *self)
{
    if (zd_output_has_dense(self)) return leave_for_polynomial(self);
    zd_output_save_end(self);
    return ZD_DONE;
}

int zd_output_make_shorter(zd_output *self, double t)
{
    self->is_prepared = 0;
    int status = zd_stepper_return_to(self->stepper, &self->before);
    return status ? status : zd_substep(self->loop, t);
}

int zd_output_go(zd_output *self, double t)
{
    if (self->is_prepared) {
        int status = zd_dense_output_move(self->stepper, t);
        if (!status || zd_callable_failed(self->stepper->motion, status)) return status;
        status = go_on_with_shorter_steps(self);
        if (status) return status;
    }
    return zd_output_make_shorter(self, t);
}

static int is_wanted(const zd_output *self, double until)
{
    return !zd_output_is_complete(self) && self->t_eval[self->next] <= until;
}

static int is_wanted_before(const zd_output *self, double t)
{
    return !zd_output_is_complete(self) && self->t_eval[self->next] < t;
}

/* Moves to the next requested time within the step. */
static int move_to_next(zd_output *self)
{
    const double t = self->t_eval[self->next++];
    int status = self->is_within ? ZD_DONE : zd_output_leave(self);
    return status ? status : zd_output_go(self, t);
}

/* Saves the samples within the step. */
static int save_within(zd_output *self, zd_record *record)
{
    int status = ZD_DONE;
    while (!status && is_wanted_before(self, self->after.state.t)) {
        if (!zd_record_has_room(record)) return ZD_FULL;
        status = move_to_next(self);
        if (!status) status = zd_recorder_add(self->recorder, record);
    }
    return status;
}

/* Returns to the end of the step, and saves it if requested. */
static int save_end(zd_output *self, zd_record *record, int is_end)
{
    const double t1 = self->after.state.t;
    int status = self->is_within ? zd_output_return_to_end(self) : ZD_DONE;
    const int here = is_wanted(self, t1);
    if (status || !(here || is_end)) return status;
    if (!zd_record_has_room(record)) return ZD_FULL;
    self->next += here;
    return zd_recorder_add(self->recorder, record);
}

int zd_output_after(zd_output *self, zd_record *record, int is_end)
{
    if (!self->is_open && !is_wanted(self, self->stepper->t)) return is_end ? zd_recorder_add(self->recorder, record) : ZD_DONE;
    if (!self->is_open) self->after.state.t = self->stepper->t;
    int status = save_within(self, record);
    if (!status) status = save_end(self, record, is_end);
    self->is_open = status == ZD_FULL;
    return status;
}

int zd_output_is_complete(const zd_output *self)
{
    return self->next == self->t_evals;
}
