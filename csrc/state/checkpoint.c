/* The integrator's state (a Jacobian, results of its last iteration) and the formulation's (its choice of variables) each occupy one span of
 * memory, which is copied whole, without knowledge of its contents. Its size is about that of the data a step writes. Memory that was
 * allocated on demand is not copied.
 */
#include "stepper.h"

#include <string.h>

#include "../constraints/rank.h"
#include "../linalg/small.h"

zd_checkpoint zd_checkpoint_create(zd_arena *arena, const zd_stepper *stepper)
{
    return (zd_checkpoint){
        .of_integrator = zd_arena_bytes(arena, stepper->memory_of_integrator.bytes),
        .of_chosen = zd_arena_bytes(arena, stepper->motion->memory_of_chosen.bytes),
        .y = zd_arena_doubles(arena, (size_t)stepper->capacity),
    };
}

void zd_checkpoint_set(zd_checkpoint *self, const zd_stepper *stepper)
{
    zd_checkpoint_set_variables(self, stepper);
    memcpy(self->of_integrator, stepper->memory_of_integrator.at, stepper->memory_of_integrator.bytes);
    self->has_integrator = 1;
}

void zd_checkpoint_set_variables(zd_checkpoint *self, const zd_stepper *stepper)
{
    const zd_motion *motion = stepper->motion;
    zd_rank *rank = motion->point->rank;
    memcpy(self->of_chosen, motion->memory_of_chosen.at, motion->memory_of_chosen.bytes);
    zd_copy(motion->rate.size, stepper->y, self->y);
    self->formulation = motion->formulation;
    self->was_ill_conditioned = rank->was_ill_conditioned;
    self->was_deficient = rank->was_deficient;
    self->was_doubtful = rank->was_doubtful;
    self->has_integrator = 0;
    self->is_set = rank->is_auxiliary = 1;
}

int zd_checkpoint_return(zd_checkpoint *self, zd_stepper *stepper, const zd_state *end)
{
    zd_motion *motion = stepper->motion;
    zd_rank *rank = motion->point->rank;
    if (self->has_integrator) memcpy(stepper->memory_of_integrator.at, self->of_integrator, stepper->memory_of_integrator.bytes);
    memcpy(motion->memory_of_chosen.at, self->of_chosen, motion->memory_of_chosen.bytes);
    zd_variables_restore(stepper, self->formulation);
    rank->is_auxiliary = 0;
    motion->point->known &= motion->point->constant;    /* the point may be at this state already, with other factors */
    int status = zd_stepper_return_to(stepper, end);
    zd_copy(motion->rate.size, self->y, stepper->y);
    rank->was_ill_conditioned = self->was_ill_conditioned;
    rank->was_deficient = self->was_deficient;
    rank->was_doubtful = self->was_doubtful;
    self->is_set = 0;
    return status;
}
