/* The integrator's memory (a Jacobian, results of its last iteration) and the formulation's (its choice of variables) each occupy one span of
 * memory, which is copied whole, without knowledge of its contents. Its size is about that of the data a step writes. Memory that was
 * allocated on demand is not copied.
 */
#include "snapshot.h"

#include <string.h>

#include "../constraints/rank.h"
#include "../linalg/small.h"

zd_snapshot zd_snapshot_create(zd_arena *arena, const zd_stepper *stepper)
{
    const zd_motion *motion = stepper->motion;
    const zd_system *system = &motion->system;
    const size_t nv = system->nv;
    const int is_complete = !motion->formulation->update;     /* then y begins with p and v, as in zd_last */
    double *y = zd_arena_doubles(arena, stepper->capacity);
    zd_snapshot self = {
        .state = {.p = y, .v = y ? y + system->nq : NULL},
        .has_accelerations = !zd_has_input(system) && !motion->corrections_size && !(system->provides & ZD_A) && !motion->reactions.reading,
        .of_integrator = zd_arena_copy(arena, stepper->memory_of_integrator.at, stepper->memory_of_integrator.bytes),
        .of_chosen = zd_arena_copy(arena, motion->memory_of_chosen.at, motion->memory_of_chosen.bytes),
        .y = y,
    };
    if (!is_complete) self.state = zd_state_create(arena, motion);
    if (!self.has_accelerations) return self;
    self.accelerations.vdot = zd_arena_doubles(arena, nv + (size_t)zd_constraints(system));
    self.accelerations.pivots = zd_arena_doubles(arena, nv);
    return self;
}

static void take_accelerations(zd_snapshot *self, const zd_motion *motion)
{
    const zd_point *point = motion->point;
    zd_cached_accelerations *to = &self->accelerations;
    const int may_keep = !motion->formulation->update;
    to->are_known = self->has_accelerations && may_keep && (point->known & ZD_ACCELERATED);
    self->is_factored = may_keep && !to->are_known && (point->known & ZD_FACTORED);
    if (!to->are_known) return;
    zd_rank_find_multipliers(point);
    to->order = motion->path.order;
    to->smallest = motion->path.smallest;
    zd_copy_few(motion->system.nv + zd_constraints(&motion->system), point->vdot, to->vdot);
    if (to->order >= 0) zd_copy_few(motion->system.nv, motion->path.pivots, to->pivots);
}

static int restore_accelerations(const zd_snapshot *self, zd_motion *motion)
{
    const zd_cached_accelerations *from = &self->accelerations;
    /* A factorization that includes a right-hand side rounds differently from a later solve, so it is repeated. */
    if (self->is_factored) return zd_motion_factor(motion);
    if (!from->are_known || from->order != motion->path.order) return ZD_DONE;
    motion->point->known |= ZD_ACCELERATED;
    zd_rank_discard_awaited(motion->point);
    motion->path.smallest = from->smallest;
    zd_copy_few(motion->system.nv + zd_constraints(&motion->system), from->vdot, motion->point->vdot);
    if (from->order >= 0) zd_copy_few(motion->system.nv, from->pivots, motion->path.pivots);
    return ZD_DONE;
}

static void take_choice(zd_snapshot *self, const zd_stepper *stepper)
{
    const zd_motion *motion = stepper->motion;
    zd_rank *rank = motion->point->rank;
    memcpy(self->of_chosen, motion->memory_of_chosen.at, motion->memory_of_chosen.bytes);
    self->is_dependent = motion->formulation != stepper->chosen.formulation;
    self->was_ill_conditioned = rank->was_ill_conditioned;
    self->was_deficient = rank->was_deficient;
    self->was_doubtful = rank->was_doubtful;
    rank->is_auxiliary = 1;
}

/* Before the motion returns: the point may be at the state already, with other factors. */
static void restore_choice(const zd_snapshot *self, zd_stepper *stepper)
{
    zd_motion *motion = stepper->motion;
    memcpy(motion->memory_of_chosen.at, self->of_chosen, motion->memory_of_chosen.bytes);
    if (!self->is_dependent) zd_variables_restore(stepper);
    motion->point->rank->is_auxiliary = 0;
    motion->point->known &= motion->point->constant;
}

static void restore_flags(const zd_snapshot *self, zd_rank *rank)
{
    rank->was_ill_conditioned = self->was_ill_conditioned;
    rank->was_deficient = self->was_deficient;
    rank->was_doubtful = self->was_doubtful;
}

void zd_snapshot_take(zd_snapshot *self, zd_stepper *stepper, int sections)
{
    self->sections = sections;
    self->state.t = stepper->t;
    zd_copy_few(stepper->motion->rate.size, stepper->y, self->y);
    if (self->state.p != self->y) zd_stepper_save_state(stepper, &self->state);
    if (sections & ZD_ACCELERATIONS) take_accelerations(self, stepper->motion);
    if (sections & (ZD_VARIABLES | ZD_MEMORY)) take_choice(self, stepper);
    if (sections & ZD_MEMORY) memcpy(self->of_integrator, stepper->memory_of_integrator.at, stepper->memory_of_integrator.bytes);
}

int zd_snapshot_restore(zd_snapshot *self, zd_stepper *stepper)
{
    const int has_choice = self->sections & (ZD_VARIABLES | ZD_MEMORY);
    if (self->sections & ZD_MEMORY) memcpy(stepper->memory_of_integrator.at, self->of_integrator, stepper->memory_of_integrator.bytes);
    if (has_choice) restore_choice(self, stepper);
    int status = ZD_DONE;
    if (self->state.p == self->y) zd_point_move(stepper->motion->point, self->state.t, self->state.p, self->state.v);
    else status = zd_stepper_return_to(stepper, &self->state);
    stepper->t = self->state.t;
    stepper->motion->state = stepper->y;
    zd_copy_few(stepper->motion->rate.size, self->y, stepper->y);
    if (has_choice) restore_flags(self, stepper->motion->point->rank);
    return status || !(self->sections & ZD_ACCELERATIONS) ? status : restore_accelerations(self, stepper->motion);
}
